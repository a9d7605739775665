#pragma once
#include <cstdint>

#include "talus/terrain/raster.hpp"

namespace talus {

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
