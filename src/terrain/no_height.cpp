#include "talus/terrain/no_height.hpp"

#include <algorithm>
#include <cmath>

#include "talus/terrain/surface.hpp"

namespace talus {
namespace {

using Place = Eigen::Vector2d;

double half_cell(const Grid& grid) {
  return 0.5 * std::min(grid.cell_x, grid.cell_y);
}

/// Adds a straight way, in equal pieces of `step` at most (by the height at their middles) that count by `weight`.
void add_way(WithoutHeight& sum, const Raster<float>& heights, const Place& from, const Place& to, double step,
             double weight) {
  constexpr double kMostPieces = 1e5;  // of a way far off the DEM
  const double length = (to - from).norm();
  if (!(length > 0.0)) return;
  const int pieces = static_cast<int>(std::clamp(std::ceil(length / step), 1.0, kMostPieces));
  double without = 0.0;
  for (int i = 0; i < pieces; ++i)
    if (!has_height(heights, from + ((i + 0.5) / pieces) * (to - from))) without += 1.0;
  sum.whole += weight * length;
  sum.without += weight * length * (without / pieces);  // exactly as much as `whole` where all are without
}

/// Where a row from west to east crosses the rings of a polygon, sorted: inside between the first and the second, the
/// third and the fourth, ...
std::vector<double> crossings_of(std::span<const std::vector<Place>> rings, double y) {
  std::vector<double> crossings;
  for (const std::vector<Place>& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Place &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() <= y) != (b.y() <= y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
  std::ranges::sort(crossings);
  return crossings;
}

}  // namespace

bool has_height(const Raster<float>& heights, const Place& place) {
  const Grid& grid = heights.grid;
  const double column = std::floor(patch_coordinate(place.x(), 1.0 / grid.cell_x)),
               row = std::floor(patch_coordinate(place.y(), 1.0 / grid.cell_y));
  if (!(column >= 0.0 && column < grid.columns - 1 && row >= 0.0 && row < grid.rows - 1)) return false;
  const int west = static_cast<int>(column), south = static_cast<int>(row);
  for (int j = south; j <= south + 1; ++j)
    for (int i = west; i <= west + 1; ++i)
      if (std::isnan(heights.at(i, j))) return false;
  return true;
}

void add_line(WithoutHeight& sum, const Raster<float>& heights, std::span<const Place> line) {
  for (std::size_t i = 1; i < line.size(); ++i)
    add_way(sum, heights, line[i - 1], line[i], half_cell(heights.grid), 1.0);
}

void add_polygon(WithoutHeight& sum, const Raster<float>& heights, std::span<const std::vector<Place>> rings) {
  if (rings.empty() || rings.front().empty()) return;
  Place low = rings.front().front(), high = low;
  for (const Place& place : rings.front()) low = low.cwiseMin(place), high = high.cwiseMax(place);
  const int rows = static_cast<int>(std::clamp(std::ceil((high.y() - low.y()) / half_cell(heights.grid)), 16.0, 256.0));
  const double height = (high.y() - low.y()) / rows,
               step = std::max(half_cell(heights.grid), (high.x() - low.x()) / 256.0);
  for (int row = 0; row < rows; ++row) {
    const double y = low.y() + (row + 0.5) * height;
    const std::vector<double> x = crossings_of(rings, y);
    for (std::size_t i = 1; i < x.size(); i += 2) add_way(sum, heights, {x[i - 1], y}, {x[i], y}, step, height);
  }
}

}  // namespace talus
