#pragma once
#include <string>

#include "layer.hpp"
#include "talus/terrain/grid.hpp"

namespace talus::io {

/// Share of a feature outside a grid, exactly, from 0 to 1: of the area of its polygons, else of the length of its
/// lines, else of the number of its points.
double share_outside(const Parts& parts, const Grid& grid);

/// Whether a box in local metres lies wholly off a grid; one that touches its border does not.
bool wholly_off(const OGREnvelope& box, const Grid& grid);

/// The system that a layer was brought from, for messages; empty if it has that of the DEM.
std::string brought_from(const Layer& layer);

/// "EXTENT (brought from CRS), the DEM over EXTENT in CRS": where features lie that are off the DEM.
/// @param box  of the features [m, local] @param from  `brought_from`; empty: nothing is said
std::string extents_text(const OGREnvelope& box, const std::string& from, const Terrain& terrain);

/// The error for a layer whose features are all off the DEM, with both extents. @param box  of the features [m, local]
std::string off_dem_text(const std::string& path, const OGREnvelope& box, const Layer& layer, const Terrain& terrain);

/// "polygon", "line", "point" or "feature", by what it is made of.
const char* kind_of(const Parts& parts);

}  // namespace talus::io
