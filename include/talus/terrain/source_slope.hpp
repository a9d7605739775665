#pragma once
#include "talus/terrain/raster.hpp"

namespace talus {

/// Steepness of a cell by Horn's formula over its eight neighbours, as in `gdaldem slope`, QGIS and ArcGIS.
///
///   z_x = ((z_NE + 2 z_E + z_SE) - (z_NW + 2 z_W + z_SW)) / (8 dx), z_y likewise
///
/// @return tangent of the slope angle [m/m]; NaN if one of the nine heights is missing or off the grid
/// Source: Horn (1981), "Hill shading and the reflectance map", Proc. IEEE 69(1).
double horn_slope(const Raster<float>& heights, int column, int row);

/// Area of the ground in a cell on a slope: its area in plan over the cosine of the slope [m^2].
///
/// @param tangent  of the slope angle [m/m]
double true_area(const Grid& grid, double tangent);

/// Area of the ground in a cell of a DEM [m^2], with the slope by `horn_slope`. A missing height of a neighbour is
/// replaced: at a side by going on as from the opposite side (level where both are missing), at a corner by the plane
/// through the cell and the two sides beside the corner.
double true_area(const Raster<float>& heights, int column, int row);

/// Default threshold of source cells: a cell at least this steep is a candidate source [rad].
///
///   55 deg * (cell / 1 m)^-0.075
///
/// Coarse cells smooth cliffs away, so the threshold falls as they grow: 55 deg at 1 m, 48.7 at 5 m, 43.2 at 25 m.
/// @param cell size of the cells [m], > 0
/// Source: docs/sources.md, "The threshold". It is an assumption; that section gives its basis.
double default_source_slope(double cell);

}  // namespace talus
