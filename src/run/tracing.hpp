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

/// The command line with --resume, as a shell reads it.
std::string command_to_resume(const std::vector<std::string>& command);

/// Traces all rounds of a session and saves a checkpoint from time to time. Each process of a group has one; all call
/// the same functions in the same order.
class Tracing {
 public:
  struct Means {
    io::OutputFolder* folder;  ///< of the results; null except in the leader
    Observer& observer;
    ProcessGroup& processes;
    MemoryPolicy memory;
  };
  /// Resumes from the checkpoint in the folder, if there is one. The request and the plan must outlive it.
  Tracing(const RunRequest& request, const RunPlan& plan, const Means& means);

  Checkpoint& checkpoint() { return checkpoints_.front(); }
  std::span<const Checkpoint> checkpoints() const { return checkpoints_; }
  Tally& tally() { return tally_; }
  std::uint32_t rounds_done() const { return simulation_.position().round + (simulation_.round_done() ? 1U : 0U); }
  /// Trajectories traced by this process; in the leader with those of the checkpoint.
  std::uint64_t traced() const { return simulation_.totals().released; }

  /// Traces all rounds. If the user ends the program, saves the work and throws `Interrupted`.
  void trace(int threads, int lanes);
  /// Sum of the totals of all processes. Only the leader gets it.
  Totals totals();
  void save_checkpoint();
  /// Saves what was traced since the last checkpoint if that is much, or if a process group has traced it, which cannot
  /// save it while the leader writes. Does nothing if none was saved yet.
  void save_before_writing();
  /// Throws `Interrupted` while the leader writes the results. A single process saves its work first; a process group
  /// resumes from the last checkpoint.
  [[noreturn]] void interrupt_writing();
  /// Accuracy reached so far, for `--until-error`. Shares out the tally over the process group.
  Accuracy accuracy();

 private:
  std::vector<Checkpoint> opened() const;
  Checkpoint resumed(const std::filesystem::path& work) const;
  double seconds_since_checkpoint() const { return std::chrono::duration<double>(Clock::now() - saved_at_).count(); }
  bool in_any_process(bool here) { return processes_.largest(here ? 1 : 0) > 0; }
  bool enough();
  /// Saves what was traced and throws `Interrupted` with the command that resumes.
  [[noreturn]] void interrupt();

  using Clock = std::chrono::steady_clock;
  const RunRequest& request_;
  const RunPlan& plan_;
  io::OutputFolder* folder_;
  Observer& observer_;
  ProcessGroup& processes_;
  Tally tally_;
  std::vector<Checkpoint> checkpoints_;  // exactly one
  Sinks sinks_;
  Simulation simulation_;
  Clock::time_point saved_at_ = Clock::now();
  bool all_saved_ = true;
};

}  // namespace talus::run
