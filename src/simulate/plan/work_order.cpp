#include "talus/simulate/plan/work_order.hpp"

#include <algorithm>
#include <numeric>

#include "talus/simulate/plan/region.hpp"

namespace talus {
namespace {

/// Spreads the bits of a number: bit i becomes bit 2 i.
std::uint64_t spread(std::uint32_t number) {
  std::uint64_t bits = number;
  bits = (bits | bits << 16U) & 0x0000FFFF0000FFFFU;
  bits = (bits | bits << 8U) & 0x00FF00FF00FF00FFU;
  bits = (bits | bits << 4U) & 0x0F0F0F0F0F0F0F0FU;
  bits = (bits | bits << 2U) & 0x3333333333333333U;
  return (bits | bits << 1U) & 0x5555555555555555U;
}

}  // namespace

std::vector<std::uint32_t> work_order(const Grid& grid, std::span<const SourceCell> sources) {
  std::vector<std::uint64_t> place;
  place.reserve(sources.size());
  for (const SourceCell& cell : sources)
    place.push_back(spread(static_cast<std::uint32_t>(grid.column_of(cell.x) / kRegionSide)) |
                    spread(static_cast<std::uint32_t>(grid.row_of(cell.y) / kRegionSide)) << 1U);
  std::vector<std::uint32_t> order(sources.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place[a] < place[b]; });
  return order;
}

}  // namespace talus
