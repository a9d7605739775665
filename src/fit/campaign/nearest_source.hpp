#pragma once
#include <cstdint>
#include <vector>

#include "talus/terrain/raster.hpp"

namespace talus {

/// Mark of a cell that holds no source.
inline constexpr std::uint32_t kNoSource = 0xFFFFFFFF;

/// For each cell the number of the source whose cell's centre is nearest in plan; of two at one distance, that of the
/// column, then of the row, further west or south. Exact, O(cells).
///
/// @param sources  number of the source that a cell holds, or kNoSource; at least one cell holds one
/// Source: Felzenszwalb & Huttenlocher (2012), "Distance transforms of sampled functions".
Raster<std::uint32_t> nearest_sources(const Raster<std::uint32_t>& sources);

}  // namespace talus
