#include "talus/products/gully_stops.hpp"

#include "talus/terrain/steep_gully.hpp"

namespace talus {

void GullyStops::add(std::span<const StopRow> rows) {
  const Raster<float>& heights = scenario_.surface.heights();
  for (const StopRow& stop : rows) {
    if (!rests_on_ground(stop.end)) continue;
    const int column = heights.grid.column_of(stop.x), row = heights.grid.row_of(stop.y);
    if (!heights.grid.contains(column, row)) continue;
    const Ground& ground = scenario_.cover.grounds[scenario_.cover.zone_at(stop.x, stop.y)];
    if (in_steep_gully(heights, column, row, ground.tan_phi)) ++by_cell_[heights.grid.index(column, row)];
  }
}

std::uint64_t GullyStops::blocks() const {
  std::uint64_t sum = 0;
  for (const auto& [cell, blocks] : by_cell_) sum += blocks;
  return sum;
}

std::optional<GullyStops::Cell> GullyStops::worst() const {
  const std::pair<const std::size_t, std::uint64_t>* most = nullptr;
  for (const auto& one : by_cell_)
    if (most == nullptr || one.second > most->second || (one.second == most->second && one.first < most->first))
      most = &one;
  if (most == nullptr) return std::nullopt;
  const auto columns = static_cast<std::size_t>(scenario_.surface.grid().columns);
  return Cell{static_cast<int>(most->first % columns), static_cast<int>(most->first / columns), most->second};
}

}  // namespace talus
