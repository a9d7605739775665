#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// One line that the results of a run must not be used, with its status; nothing where it is complete.
std::optional<std::string> unusable_note(const std::filesystem::path& folder);

/// One line that energies rest on c (model.deformation_coefficient), and which way is safe; nothing if c is low. With a
/// folder: of its run.json, nothing if it has none. docs/barrier.md, "The value of c".
///
/// @param of_profile  the run is of `talus profile`, which takes c from its file alone
std::optional<std::string> coefficient_note(double c, bool of_profile = false);
std::optional<std::string> coefficient_note(const std::filesystem::path& folder);

/// "2 barriers stood in the run and caught 3335 blocks"; "blocks and pieces" if blocks broke.
/// @param caught  their number as text
std::string barriers_text(std::size_t barriers, const std::string& caught, bool pieces);

/// One line that the figures hold only while the barriers of the run stand; nothing if none stood there.
std::optional<std::string> barriers_note(const std::filesystem::path& folder);

/// One line that the figures are those of a wet day; nothing if wet-ground does not act on the day of the run.
/// docs/effects.md, "wet-ground".
///
/// @param per_year  there are figures per year
std::optional<std::string> wet_day_note(const std::filesystem::path& folder, bool per_year);

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

/// One line that the figures hold only while the forest of the run stands; nothing if none acted there.
std::optional<std::string> forest_note(const std::filesystem::path& folder);

/// The part of OUT/run.json that products of a finished run need.
struct RunSummary {
  bool of_profile = false;                 ///< of `talus profile`
  double released = 0.0;                   ///< trajectories
  double density = 0.0;                    ///< of the rock [kg/m^3]
  double cell = 0.0;                       ///< side of a cell, from west to east [m]
  std::string crs_wkt;                     ///< of the map; empty if it has none
  std::vector<Screen> screens;             ///< in map coordinates [m]
  std::vector<double> without_height;      ///< of each screen: share of its length that blocks cannot cross, from 1 %
  std::vector<std::string> size_warnings;  ///< about block sizes, and ground that was fitted to no data
};

/// Reads OUT/run.json. Throws InputError if it cannot be read or `talus run` has not written it.
RunSummary read_run(const std::filesystem::path& folder);

/// The warnings of the run about sources that release nothing, as a whole or in part; none if there is no run.json that
/// can be read.
///
/// @param reweighted  by other frequencies than the run's: warnings with events per year say whose they are
std::vector<std::string> cut_source_warnings_of(const std::filesystem::path& folder, bool reweighted);

/// RunSummary::size_warnings alone; none if there is no run.json that can be read.
std::vector<std::string> size_warnings_of(const std::filesystem::path& folder);

}  // namespace talus::io
