#pragma once
#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "progress.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/run/checkpoint.hpp"
#include "talus/products/accuracy.hpp"

/// What `run` was asked for.
struct RunOptions {
  talus::io::RunFlags flags;
  std::string out, progress;
  std::optional<std::string> part;  ///< "I/N"; nothing: the whole run
  talus::Rounds rounds;
  std::string memory;
  double checkpoint = 30.0;
  int threads = 0;
  bool overwrite = false, resume = false, quiet = false;
};

/// The simulation of one command, with what it keeps on the disk. Each process of the process group has one, and all call the
/// same of it.
class RunSession {
 public:
  /// @param folder  of the results: the leader's; elsewhere null
  RunSession(const RunOptions& options, const talus::io::LoadedScenario& loaded, const talus::Part& part,
          talus::io::OutputFolder* folder, Progress& progress, talus::ProcessGroup& processes);

  talus::io::Checkpoint& checkpoint() { return checkpoints_.front(); }
  std::span<const talus::io::Checkpoint> checkpoints() const { return checkpoints_; }
  talus::Tally& tally() { return tally_; }
  std::uint32_t rounds_done() const { return simulation_.position().round + (simulation_.round_done() ? 1U : 0U); }

  std::uint64_t traced() const { return simulation_.totals().released; }  ///< by this process, and what was kept

  /// Traces all rounds. Throws `Interrupted`, after what is done was kept.
  void trace(int threads, Progress& progress);
  /// What all have traced; at the leader.
  talus::Totals totals();
  void keep();
  /// Where something was kept before, what was traced since is kept, too.
  void keep_the_rest();
  /// Whether something was: an interrupted run can go on.
  bool is_kept() { return !checkpoint().empty(); }
  /// Keeps what was traced and throws `Interrupted`, which says how to go on.
  [[noreturn]] void interrupt();
  /// The same while the leader writes the results: of a process group what was kept last must do.
  [[noreturn]] void interrupt_writing();
  /// What `--until-error` asks of the cells, so far; the tally is then shared out over the process group.
  talus::Accuracy accuracy();

 private:
  std::vector<talus::io::Checkpoint> opened(const talus::io::LoadedScenario& loaded, const talus::Part& part);
  double seconds_since_kept() const { return std::chrono::duration<double>(Clock::now() - kept_).count(); }
  bool any(bool here) { return processes_.largest(here ? 1 : 0) > 0; }
  bool enough();

  using Clock = std::chrono::steady_clock;
  const RunOptions& options_;
  const talus::Scenario& scenario_;
  talus::io::OutputFolder* folder_;
  talus::ProcessGroup& processes_;
  talus::Tally tally_;
  std::vector<talus::io::Checkpoint> checkpoints_;  // one
  talus::Sinks sinks_;
  talus::Simulation simulation_;
  Clock::time_point kept_ = Clock::now();
  bool all_kept_ = true;
};
