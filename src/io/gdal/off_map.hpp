#pragma once
#include <string>

#include "layer.hpp"
#include "talus/terrain/grid.hpp"

namespace talus::io {

/// Share of a feature outside a grid, exactly, from 0 to 1: of the area of its polygons, else of the length of its
/// lines, else of the number of its points.
double share_outside(const Parts& parts, const Grid& grid);

/// The error for a layer whose features are all off the DEM, with both extents. @param box  of the features [m, local]
std::string off_dem_text(const std::string& path, const OGREnvelope& box, const Layer& layer, const Terrain& terrain);

/// "polygon", "line", "point" or "feature", by what it is made of.
const char* kind_of(const Parts& parts);

}  // namespace talus::io
