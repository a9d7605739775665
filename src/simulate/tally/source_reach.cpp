#include "talus/simulate/tally/source_reach.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace talus {
namespace {

constexpr std::size_t kWords = kRegionCells / 64;
using CellWords = std::array<std::uint64_t, kWords>;

CellWords words_of(const SourceReach::Cells& cells) {
  CellWords words{};
  for (std::size_t i = 0; i < kRegionCells; ++i) words[i / 64] |= std::uint64_t{cells[i]} << (i % 64);
  return words;
}

}  // namespace

void SourceReach::save(ByteWriter& out) const {
  std::vector<std::size_t> order;
  for (const auto& [region, cells] : regions_) order.push_back(region);
  std::sort(order.begin(), order.end());
  out.put(static_cast<std::uint64_t>(order.size()));
  for (const std::size_t region : order) {
    out.put(static_cast<std::uint64_t>(region));
    out.put(words_of(regions_.at(region)));
  }
}

void SourceReach::restore(ByteReader& in) {
  const auto count = in.get<std::uint64_t>();
  for (std::uint64_t k = 0; k < count; ++k) {
    Cells& cells = this->cells(in.get<std::uint64_t>());
    const CellWords words = in.get<CellWords>();
    for (std::size_t i = 0; i < kRegionCells; ++i) cells[i] = (words[i / 64] >> (i % 64) & 1U) != 0;
  }
}

}  // namespace talus
