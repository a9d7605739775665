#pragma once
#include <filesystem>
#include <span>

#include "talus/run/checkpoint.hpp"
#include "talus/run/run_session.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus::run {

/// All that the results of a run are written from, and where to.
struct ResultSource {
  const io::LoadedScenario& loaded;
  std::span<const Checkpoint> checkpoints;  ///< one, or the parts in their order; all with the same number of rounds
  const Tally& tally;
  std::filesystem::path folder;
};

/// Writes every result: maps from the tally, vectors from the rows in the checkpoints. Fills the record.
void write_results(const ResultSource& source, Observer& observer, Stopwatch& watch, io::RunRecord& record);

/// Says what was done, after the warnings from number `told` on.
void summarise(const io::RunRecord& record, const io::LoadedScenario& loaded, std::size_t told,
               const std::filesystem::path& folder, Observer& observer);

/// Says what went wrong where too many trajectories ended at a limit, and how to look into it.
Outcome judge_limits(const Totals& totals, const std::filesystem::path& folder, Observer& observer);

}  // namespace talus::run
