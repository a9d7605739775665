#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "progress.hpp"
#include "run_support.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/run/checkpoint.hpp"

/// What `run` and `merge` do once all trajectories are traced.

/// Writes every result into `folder`: maps from the tally, vectors from the rows that the checkpoints keep. Fills the
/// record.
///
/// @param checkpoints  one, or the parts in their order; all with the same number of rounds
void write_results(const talus::io::LoadedScenario& loaded, std::span<const talus::io::Checkpoint> checkpoints,
                   const talus::Tally& tally, const std::filesystem::path& folder, Stopwatch& watch, Progress& progress,
                   talus::io::RunRecord& record);

/// Tells what was done, after the warnings from number `told` on.
void summarise(const talus::io::RunRecord& record, const talus::io::LoadedScenario& loaded, std::size_t told,
               const std::string& folder);

/// What is to be said of trajectories that left; nothing where they are few.
std::vector<std::string> warnings_of(const talus::Totals& totals);

/// The exit code: says what went wrong where too many trajectories ended at a limit, and how to look into it.
int judge_limits(const talus::Totals& totals, const std::filesystem::path& folder);
