#include "talus/simulate/tally/source_reach.hpp"

#include <algorithm>
#include <vector>

namespace talus {

static_assert(sizeof(SourceReach::Cells) == kRegionCells / 8, "the cells are saved as their bits alone");

void SourceReach::save(ByteWriter& out) const {
  std::vector<std::size_t> order;
  for (const auto& [region, cells] : regions_) order.push_back(region);
  std::sort(order.begin(), order.end());
  out.put(static_cast<std::uint64_t>(order.size()));
  for (const std::size_t region : order) {
    out.put(static_cast<std::uint64_t>(region));
    out.put(regions_.at(region));
  }
}

void SourceReach::restore(ByteReader& in) {
  const auto count = in.get<std::uint64_t>();
  for (std::uint64_t k = 0; k < count; ++k) {
    Cells& to = cells(in.get<std::uint64_t>());
    to = in.get<Cells>();
  }
}

}  // namespace talus
