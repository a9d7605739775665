#pragma once
#include "talus/terrain/raster.hpp"

namespace talus {

/// Whether a cell belongs to a gully that is too steep to rest in. A DEM shows a gully about as narrow as a cell as a
/// staircase: its treads are flat enough to hold blocks, though the gully is not. The cell counts if
///
/// - the ground over its eight neighbours (`horn_slope`) is steeper than friction holds, and
/// - it has walls, or one of these neighbours is as steep and has walls: along a row, a column or a diagonal the ground
///   rises to both sides more steeply than friction holds.
///
/// @param tan_phi  tangent of the friction angle of the ground [-]
/// @return false for a cell at the edge of the grid or beside missing heights
/// Source: docs/physics.md, "Steep gullies". The only number is the friction angle.
bool in_steep_gully(const Raster<float>& heights, int column, int row, double tan_phi);

}  // namespace talus
