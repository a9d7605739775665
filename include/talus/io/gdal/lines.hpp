#pragma once
#include <span>
#include <string>
#include <vector>

#include "talus/io/gdal/rasters.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// Screens (lines whose crossings are recorded) from a vector file.
struct ScreenLayer {
  std::vector<Screen> screens;
  std::vector<Reprojection> reprojections;
  std::vector<std::string> notes;  ///< which fields were read
  std::vector<std::string> warnings;
};

/// Reads screens: lines with a field `id` (text or whole number; else the number of the feature). Lines of the same id,
/// and the parts of a multiline, are one screen. A plain CSV with columns id,wkt is in the system of the DEM. Warns of
/// screens that lie, wholly or partly, where the DEM has no height.
ScreenLayer read_screens(const std::string& path, const Terrain& terrain);

/// Share of the length of a screen where the terrain has no height: blocks do not get there.
double share_without_height(const Screen& screen, const Raster<float>& heights);

/// Barriers from a vector file.
struct BarrierLayer {
  std::vector<Barrier> barriers;
  std::vector<Reprojection> reprojections;
  std::vector<std::string> notes;  ///< which fields were read
  std::vector<std::string> warnings;
};

/// Reads barriers: lines with the fields `height` [m] and `capacity` [kJ], which must be there, and `id` as for
/// screens. Each feature is one barrier.
BarrierLayer read_barriers(const std::string& path, const Terrain& terrain);

/// Warns of barriers that lie wholly off the DEM, as `read_barriers` does, but by their ids.
/// @param where  that names them: "barriers.line (scenario)"
void warn_of_barriers_off(const std::string& where, std::span<const Barrier> barriers, const Terrain& terrain,
                          std::vector<std::string>& warnings);

}  // namespace talus::io
