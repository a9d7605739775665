#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io {

/// Name of the project in a folder of results.
inline constexpr const char* kProjectFile = "talus.qgs";

/// The ground of a map: its place, and the DEM.
struct ProjectGround {
  GeoReference geo;
  int columns, rows;
  std::filesystem::path dem;        ///< absolute; of a DEM that is no plain file, or not there, no hillshade is drawn
  std::vector<InputFile> inputs{};  ///< of the run; the sources and barriers among them are drawn, where they can be
  std::vector<Setting> settings{};  ///< of the run; titles name some of them
};
ProjectGround ground_of(const LoadedScenario& loaded);
/// The ground of the run in a folder, from its run.json. Throws InputError or an exception of the record.
ProjectGround ground_of_run(const std::filesystem::path& folder);

/// A project of QGIS (3.22 and later) that opens the results of a folder as one group: layers with their tables, the
/// sources and barriers of the run, maps with the hazard class on top, with titles and in their styles, over a
/// hillshade that QGIS makes of the DEM. Paths are relative.
///
/// @param files  names in the folder; maps, layers and tables of this program are shown
/// @param folder  where they are now
/// @param shown_as  where the folder will be
std::string project_of(const std::vector<std::string>& files, const std::filesystem::path& folder,
                       const std::filesystem::path& shown_as, const ProjectGround& ground);

/// Writes the project of a finished run anew, with all the results that are in its folder now, designs among them.
/// @return false if QGIS has saved it since: then it stays as the user has left it
bool refresh_project(const std::filesystem::path& folder);

/// A result in the group. "<n>" is a number and "<id>" an id, the same in both texts; "<threshold>" is in the title
/// only.
struct ProjectLayer {
  std::string file;            ///< "return_period_<n>.tif"; ".gpkg" is also ".fgb"; ".csv" is a table
  std::string title;           ///< "Return period of more than <n> kJ"
  bool shown = false;          ///< at first; of the maps only one: the hazard class, if there is one
  bool counts_energy = false;  ///< its title says which energy the run counts
  std::string thresholds{};    ///< setting of the run, whose lowest number <threshold> is: "output.energy_thresholds"
  std::string style{};         ///< of a mark over the map of the file; without this style there is no layer
};
/// From the top of the group downwards.
const std::vector<ProjectLayer>& project_layers();

}  // namespace talus::io
