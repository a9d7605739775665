#pragma once

namespace talus {

/// Number of cells on a side of a region. The grid is scored in square regions, and source cells are worked off region
/// by region.
inline constexpr int kRegionSide = 64;
inline constexpr int kRegionCells = kRegionSide * kRegionSide;

}  // namespace talus
