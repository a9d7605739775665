#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "talus/io/results/weighting_file.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

struct LoadedScenario;

/// How a command uses the results of a run.
struct ResultsUse {
  const GivenFrequencies& frequency;  ///< another weighting than the run's; without a file: the run's own
  bool per_year;                      ///< there are figures per year
  bool of_line;                       ///< of the crossings of one screen; else maps
};

/// Notes for everyone who uses the results of a run, from its run.json:
///   that the sizes of blocks or the ground are no fitted ones, that the fit does not hold, that sources release
///   nothing or overlap; that its status is not complete; `later_version_note`; `coefficient_note`; that the figures
///   hold only with the barriers and the forest of the run, and on a wet day.
/// None if there is no run.json that can be read. Throws InputError if it is none of a run.
std::vector<std::string> notes_of_run(const std::filesystem::path& folder, const ResultsUse& use);

/// A note if results are of a later version than this program: later by its first or second number.
/// @param written  the version in run.json, such as "0.1.0"
std::optional<std::string> later_version_note(const std::string& written);

/// One line that energies rest on c (model.deformation_coefficient), and which way is safe; nothing if c is low.
/// docs/barrier.md, "The value of c".
/// @param fitted  the ground was fitted: another c needs another fit
std::optional<std::string> coefficient_note(double c, bool fitted);
/// This line for a run. Its settings tell whether the ground was fitted.
std::optional<std::string> coefficient_note(const LoadedScenario& loaded);

/// "2 barriers stood in the run and caught 3335 blocks"; "blocks and pieces" if blocks broke.
/// @param caught  their number as text
std::string barriers_text(std::size_t barriers, const std::string& caught, bool pieces);

/// Sentence on the hits of objects in a run whose blocks broke.
inline constexpr const char* kHitsOfPieces =
    "hits of objects are falls: a block with its pieces counts once; maps of --width count every piece";

/// That sentence; nothing if no block of the run broke.
std::optional<std::string> pieces_note(const std::filesystem::path& folder);

/// Warning of the bounds of `--width` in a run whose blocks broke.
inline constexpr const char* kBoundsOfPieces =
    "blocks broke in this run, and the bounds of --width take the pieces of a block for independent hits: they are too "
    "narrow where several of them pass (unsafe); --objects counts a block with its pieces once";

/// "forest or other vegetation stood in the run (forest-stems)"; empty if none of these effects is of a stand.
/// @param effects  names of those that acted
std::string forest_text(const std::vector<std::string>& effects);

/// The part of OUT/run.json that products of a finished run need.
struct RunSummary {
  bool of_profile = false;             ///< of `talus profile`
  double released = 0.0;               ///< trajectories
  double left = 0.0;                   ///< of them left the terrain, also with a piece alone
  double left_into_gaps = 0.0;         ///< of them into gaps inside the DEM
  bool pieces = false;                 ///< blocks broke
  double density = 0.0;                ///< of the rock [kg/m^3]
  double cell = 0.0;                   ///< side of a cell, from west to east [m]
  std::string crs_wkt;                 ///< of the map; empty if it has none
  std::vector<Screen> screens;         ///< in map coordinates [m]
  std::vector<double> without_height;  ///< of each screen: share of its length that blocks cannot cross, from 1 %
};

/// Reads OUT/run.json. Throws InputError if it cannot be read or `talus run` has not written it.
RunSummary read_run(const std::filesystem::path& folder);

/// Throws InputError if OUT/run.json cannot be read, or is of another plan than hazard_tally.gz beside it.
///
/// @param plan  of hazard_tally.gz
void require_plan_of_tally(const std::filesystem::path& folder, const std::string& plan);

/// One line that many blocks may have left the terrain above a screen, so that its crossings are too few; nothing if
/// they are few (`kWarnedLeftShare`).
///
/// @param before   number of blocks that left and did not cross the screen; nothing: not known
/// @param crossed  number of blocks that cross the screen
std::optional<std::string> left_note(const RunSummary& run, const std::optional<std::size_t>& before,
                                     std::size_t crossed);

}  // namespace talus::io
