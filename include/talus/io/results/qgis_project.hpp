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
  std::filesystem::path dem;  ///< absolute; of a DEM that is no plain file, or not there, no hillshade is drawn
};
ProjectGround ground_of(const LoadedScenario& loaded);

/// A project of QGIS (3.22 and later) that opens the results of a folder as one group: with titles, in their styles,
/// the hazard class above all other maps, over a hillshade that QGIS makes of the DEM. Paths are relative.
///
/// @param files  names in the folder; maps and layers of this program are shown, in the styles beside them
/// @param folder  where they are now
/// @param shown_as  where the folder will be
std::string project_of(const std::vector<std::string>& files, const std::filesystem::path& folder,
                       const std::filesystem::path& shown_as, const ProjectGround& ground);

/// Writes the project of a finished run anew, with all the results that are in its folder now.
/// @return false if QGIS has saved it since: then it stays as the user has left it
bool refresh_project(const std::filesystem::path& folder);

/// Order and title of a layer. A name that ends in "_" or "_T" is followed by a number, "<n>" in the title.
struct ProjectLayer {
  std::string name;   ///< "return_period_"
  std::string title;  ///< "Return period of more than <n> kJ"
  bool vector = false;
};
const std::vector<ProjectLayer>& project_layers();

}  // namespace talus::io
