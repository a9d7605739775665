#include "talus/products/object_width.hpp"

#include <algorithm>
#include <cmath>

#include "talus/products/passage_bounds.hpp"

namespace talus {
namespace {

constexpr int kSamples = 32;                          // per side of a cell, for its share of the disc
constexpr double kChords = 32.0 / (3.0 * kPi * kPi);  // E[c^2] / E[c]^2 of the chords of a disc: 1.08

/// Number of samples of a cell that lie in a disc around the origin.
int samples_inside(double radius, int column, int row, double cell_x, double cell_y) {
  int inside = 0;
  for (int i = 0; i < kSamples; ++i)
    for (int j = 0; j < kSamples; ++j) {
      const double x = (column + (i + 0.5) / kSamples - 0.5) * cell_x, y = (row + (j + 0.5) / kSamples - 0.5) * cell_y;
      inside += x * x + y * y < radius * radius ? 1 : 0;
    }
  return inside;
}

}  // namespace

std::vector<PassageDensity> densities_of(const HazardCell& cell, const WeightScale& scale, double cell_area) {
  const double area = cell_area * scale.room, length = scale.unit * WeightedLengths::kLengthUnit / area,
               by_diameter = scale.unit * WeightedLengths::kDiameterUnit / area,
               squares = scale.square_unit * WeightedLengths::kLengthUnit / area;
  std::vector<PassageDensity> levels;
  for (const WeightedLengths& sums : cell.lengths())
    levels.push_back({static_cast<double>(sums.length) * length, static_cast<double>(sums.by_diameter) * by_diameter,
                      static_cast<double>(sums.squares) * squares});
  return levels;
}

Bounded hits_of_object(const PassageDensity& density, const WeightScale& scale, double width, double seen) {
  const double sum = width * density.length + density.by_diameter;
  const auto hits_of_block = [&](double diameter) { return kChords * (width + diameter) / seen; };
  const double largest = scale.largest_weight() * hits_of_block(scale.largest_diameter);
  const double mean = density.length > 0.0 ? density.by_diameter / density.length : 0.0;
  const double squares = std::min(density.squares * (width + mean) * hits_of_block(mean), sum * largest);
  return table_interval(sum, squares, largest);
}

std::vector<DiscCell> disc(double diameter, double cell_x, double cell_y) {
  const double radius = 0.5 * diameter;
  const int columns = static_cast<int>(std::ceil(radius / cell_x + 0.5)),
            rows = static_cast<int>(std::ceil(radius / cell_y + 0.5));
  std::vector<DiscCell> cells;
  double sum = 0.0;
  for (int row = -rows; row <= rows; ++row)
    for (int column = -columns; column <= columns; ++column) {
      const double share = samples_inside(radius, column, row, cell_x, cell_y);
      if (share > 0.0) cells.push_back({column, row, share});
      sum += share;
    }
  if (cells.empty()) return {{0, 0, 1.0}};  // smaller than the distance of the samples: within the cell
  for (DiscCell& cell : cells) cell.share /= sum;
  return cells;
}

}  // namespace talus
