#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The numbers of the source cells in the order of work: along a Z-order curve of the regions of the tally, and by
/// number within a region. Blocks that follow each other then run over the same terrain. Source: G. M. Morton, A
/// computer oriented geodetic data base, IBM, 1966.
std::vector<std::uint32_t> work_order(const Grid& grid, std::span<const SourceCell> sources);

}  // namespace talus
