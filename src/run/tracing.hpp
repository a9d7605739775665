#pragma once
#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "talus/base/scratch.hpp"
#include "talus/products/accuracy.hpp"
#include "talus/run/checkpoint.hpp"
#include "talus/run/run_session.hpp"
#include "talus/simulate/simulation.hpp"

namespace talus::run {

/// The command line with --resume.
std::string command_to_resume(const std::vector<std::string>& command);

/// The trajectories of a session: traces all rounds, and saves what is done in the checkpoint now and then. Each
/// process of the group has one, and all call the same of it.
class Tracing {
 public:
  struct Means {
    io::OutputFolder* folder;  ///< of the results: the leader's; elsewhere null
    Observer& observer;
    ProcessGroup& processes;
    MemoryPolicy memory;
  };
  /// Goes on from the checkpoint in the folder, where there is one. The request and the plan must outlive it.
  Tracing(const RunRequest& request, const RunPlan& plan, const Means& means);

  Checkpoint& checkpoint() { return checkpoints_.front(); }
  std::span<const Checkpoint> checkpoints() const { return checkpoints_; }
  Tally& tally() { return tally_; }
  std::uint32_t rounds_done() const { return simulation_.position().round + (simulation_.round_done() ? 1U : 0U); }
  std::uint64_t traced() const { return simulation_.totals().released; }  ///< by this process, and by the checkpoint

  /// Traces all rounds. Throws `Interrupted`, after what is done was saved.
  void trace(int threads);
  /// The totals of all processes; at the leader.
  Totals totals();
  void save_checkpoint();
  /// Where there is a checkpoint, what was traced since is saved, too.
  void save_rest();
  /// The same while the leader writes the results: of a process group the last checkpoint must do.
  [[noreturn]] void interrupt_writing();
  /// The accuracy that `--until-error` asks about, so far; the tally is then shared out over the process group.
  Accuracy accuracy();

 private:
  std::vector<Checkpoint> opened() const;
  Checkpoint resumed(const std::filesystem::path& work) const;
  double seconds_since_checkpoint() const { return std::chrono::duration<double>(Clock::now() - saved_at_).count(); }
  bool in_any_process(bool here) { return processes_.largest(here ? 1 : 0) > 0; }
  bool enough();
  /// Saves what was traced and throws `Interrupted`, which says how to go on.
  [[noreturn]] void interrupt();

  using Clock = std::chrono::steady_clock;
  const RunRequest& request_;
  const RunPlan& plan_;
  io::OutputFolder* folder_;
  Observer& observer_;
  ProcessGroup& processes_;
  Tally tally_;
  std::vector<Checkpoint> checkpoints_;  // one
  Sinks sinks_;
  Simulation simulation_;
  Clock::time_point saved_at_ = Clock::now();
  bool all_saved_ = true;
};

}  // namespace talus::run
