#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The numbers of the source cells in the order in which they are traced: by place, along a Z-order curve of the
/// regions of the tally, within a region as they are numbered. So that blocks which follow each other run over the
/// same terrain. Source: G. M. Morton, A computer oriented geodetic data base, IBM, 1966.
std::vector<std::uint32_t> work_order(const Grid& grid, std::span<const SourceCell> sources);

}  // namespace talus
