#pragma once
#include <filesystem>
#include <span>

#include "talus/run/checkpoint.hpp"
#include "talus/run/run_session.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus::run {

/// Input of `write_results`, and the folder to write into.
struct ResultSource {
  const io::LoadedScenario& loaded;
  std::span<const Checkpoint> checkpoints;  ///< one, or the parts in their order; all with the same number of rounds
  const Tally& tally;
  std::filesystem::path folder;
  std::filesystem::path final_folder;  ///< its name when it is complete
};

/// Says which results of later commands (hazard, barrier, report) go with an earlier run that is replaced.
void say_later_results(const io::OutputFolder& folder, Observer& observer);

/// Writes every result: maps from the tally, vectors from the rows in the checkpoints. Fills the record.
void write_results(const ResultSource& source, Observer& observer, Stopwatch& watch, io::RunRecord& record);

/// Reports what was done. Before that reports the warnings from index `told` on: the user knows the earlier ones.
void summarise(const io::RunRecord& record, const io::LoadedScenario& loaded, std::size_t told,
               const std::filesystem::path& folder, Observer& observer);

/// Reports an error if too many trajectories ended at a limit, with the command that replays the first one.
Outcome judge_limits(const Totals& totals, const std::filesystem::path& folder, Observer& observer);

}  // namespace talus::run
