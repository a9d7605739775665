#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/accuracy.hpp"
#include "talus/products/energy_lines.hpp"
#include "talus/simulate/totals.hpp"

namespace talus::io {

/// Largest share of trajectories that may end at a limit; above it a run counts as failed.
inline constexpr double kAllowedLimitShare = 0.001;
/// Shares of the trajectories above which a run warns: that left the terrain, that were trapped, that hardly left their
/// source, that stay in gullies too steep to rest in.
inline constexpr double kWarnedLeftShare = 0.01, kWarnedTrappedShare = 0.03, kWarnedHeldShare = 0.03,
                        kWarnedGullyShare = 0.03;
/// Words of the warnings that maps end too early.
inline constexpr std::string_view kTrappedWarning = "were trapped in pits or between walls",
                                  kGullyWarning = "stay in gullies steeper than phi",
                                  kLimitWarning = "still moved when they reached the limit of";
/// Whether a warning of a run is one of these: all who use the results are told them.
bool says_maps_end_early(const std::string& warning);
/// Which stops the energy lines of a run are of: "of 81 204 blocks that stopped farther away than 100 m".
/// @param farther_than  [m]; 0: of all
std::string energy_lines_of(std::uint64_t stops, double farther_than);

/// Seconds of the three stages of a run.
struct StageSeconds {
  double read = 0.0, simulate = 0.0, write = 0.0;
};

/// Rounds of a run.
struct RoundsRecord {
  std::uint32_t done = 0;  ///< 0: the run was not asked for rounds
  Rounds asked;
  Accuracy reached;
  bool reached_it() const { return asked.until_error && reached.cells > 0 && reached.half_width < *asked.until_error; }
};

/// Blocks that stay in gullies that are too steep to rest in: docs/physics.md, "Steep gullies".
struct GullyRecord {
  /// The cell in which most of them stay.
  struct Cell {
    double x, y;                     ///< centre [m], in the system of the DEM
    std::uint64_t blocks, passages;  ///< that stay in it, that cross it
  };
  std::uint64_t blocks = 0;
  std::optional<Cell> worst;
};

/// Record of a run.
struct RunRecord {
  std::vector<std::string> command;  ///< words of the command line
  std::string folder;                ///< of the results, absolute; empty: not recorded
  Totals totals;
  std::vector<std::string> warnings;  ///< those of the input and those of the result
  std::vector<std::string> files;     ///< written beside run.json
  std::uint64_t touched_cells = 0;
  EnergyLines energy_lines;
  std::optional<GullyRecord> gullies;           ///< nothing for a profile
  std::optional<std::uint64_t> left_into_gaps;  ///< trajectories, see `GapExits`; nothing for a profile
  StageSeconds cpu, wall;
  int threads = 0;  ///< of all processes
  int ranks = 1;    ///< processes
  int lanes = 0;    ///< trajectories in one instruction; 0: not known
  RoundsRecord rounds;
  std::uint32_t parts = 1;  ///< number of parts that were joined
  std::string plan;         ///< `plan_checksum` of one round
};

/// Whether too many trajectories ended at a limit (`kAllowedLimitShare`).
bool too_many_limits(const Totals& totals);

/// The text of run.json. Equal runs differ only in command, threads, ranks, lanes, cpu_seconds, wall_seconds
/// and peak_memory_mb.
std::string run_json(const RunRecord& record, const LoadedScenario& loaded);

/// `status` of a run whose results are good.
inline constexpr const char* kComplete = "complete";

/// `status` of the results in a folder; nothing if the folder has no results of this plan with the rounds that were
/// asked for.
std::optional<std::string> status_of_result(const std::filesystem::path& folder, const std::string& plan,
                                            const Rounds& asked);

/// Largest memory of this process so far [MB]; 0 if the system does not report it.
double peak_memory_mb();

}  // namespace talus::io
