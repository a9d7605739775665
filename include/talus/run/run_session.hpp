#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "talus/base/scratch.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/run/observer.hpp"
#include "talus/run/stopwatch.hpp"
#include "talus/simulate/plan/part.hpp"
#include "talus/simulate/plan/process_group.hpp"

namespace talus::run {

/// Options of a run.
struct RunRequest {
  io::RunFlags flags;
  std::string out;
  std::optional<std::string> part;  ///< "I/N"; nothing: the whole run
  Rounds rounds;
  std::string memory;                ///< "2G"; empty: no limit
  double checkpoint = 30.0;          ///< least time between two checkpoints [s]
  int threads = 0;                   ///< 0: all processors; with several processes one per process
  int lanes = 0;                     ///< trajectories in one instruction; 0: as many as the processor has
  std::vector<std::string> command;  ///< words of the command line
  bool overwrite = false, resume = false;
};

/// End of a run that threw no exception.
enum class Outcome { Done, TooManyLimits };

/// Scenario, part of it and rounds that a run traces.
struct RunPlan {
  io::LoadedScenario loaded;
  Part part;
  Rounds rounds;
};

class Tracing;

/// A run from its input files to its results. Owns the plan, the scratch file, the folder of results and the
/// checkpoint. Each process of a group has one; all call the same functions in the same order.
class RunSession {
 public:
  /// The observer and the processes must outlive it.
  RunSession(RunRequest request, Observer& observer, ProcessGroup& processes = alone());
  ~RunSession();
  RunSession(const RunSession&) = delete;
  RunSession& operator=(const RunSession&) = delete;

  /// Reads, traces and writes. With `resume`, returns at once if the results are there already.
  ///
  /// Throws InputError (GroupInputError with several processes), Interrupted with the command that resumes the run, or
  /// std::runtime_error.
  Outcome run();

 private:
  std::size_t check_request();
  void load(std::size_t memory);
  void read_plan(std::size_t memory, SharedMemory* shared);
  std::optional<Outcome> outcome_of_done();
  std::optional<Outcome> find_done() const;
  void make_folder();
  void warn_of_input();
  void begin_record();
  void trace();
  void with_hint(const std::function<void()>& work);
  Outcome deliver();
  Outcome deliver_part();
  Outcome deliver_results();
  MemoryPolicy memory() const { return MemoryPolicy(scratch_.get()); }

  RunRequest request_;
  Observer& observer_;
  ProcessGroup& processes_;
  int threads_;
  Stopwatch watch_;
  std::unique_ptr<ScratchFile> scratch_;  // null without a limit of memory; must outlive what it holds
  RunPlan plan_;
  std::unique_ptr<io::OutputFolder> folder_;  // null except in the leader
  std::unique_ptr<Tracing> tracing_;
  io::RunRecord record_;
};

}  // namespace talus::run
