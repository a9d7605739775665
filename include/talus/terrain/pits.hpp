#pragma once
#include <cstdint>
#include <functional>

#include "talus/terrain/raster.hpp"

namespace talus {

/// Whether a cell is lower than its four neighbours and higher than one of its diagonal ones: its way down is diagonal.
/// A bilinear surface dams it, a creased one does not. A cell at the edge of the grid or beside missing heights is not.
bool dammed(const Raster<float>& heights, int column, int row);

/// Cells with a height, and the dammed ones that count among them.
struct DamCount {
  std::uint64_t dammed = 0, cells = 0;
  double share() const { return cells > 0 ? static_cast<double>(dammed) / static_cast<double>(cells) : 0.0; }
};
/// @param counts  whether a dammed cell counts; all do where it is not given
DamCount count_dammed(const Raster<float>& heights, const std::function<bool(int column, int row)>& counts = {});

/// Height by which a dammed cell lies below the lowest of its four neighbours [m]; 0 if it is not dammed.
double dam_height(const Raster<float>& heights, int column, int row);

/// Height by which a cell lies below the lowest of its eight neighbours [m]; 0 if one of them is not higher, or has no
/// height: a block could leave there. A cell with a depth above 0 is a true pit: no interpolation of the heights lets
/// a block out of it.
double pit_depth(const Raster<float>& heights, int column, int row);

/// The true pits of a terrain.
struct PitSummary {
  std::uint64_t count = 0;
  double deepest = 0.0;  ///< largest `pit_depth` [m]
};

PitSummary summary_of_pits(const Raster<float>& heights);

}  // namespace talus
