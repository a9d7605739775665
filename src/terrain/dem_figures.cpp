#include "talus/terrain/dem_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "talus/base/vector.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus {
namespace {

/// Finds the largest of some steps of which all heights are multiples.
class StepFinder {
 public:
  void add(float height) {
    const double z = height, rounding = std::max(1e-6, std::abs(z) * 1.2e-7);  // of a float
    while (first_ < kSteps.size() && !(off(z, kSteps[first_]) <= rounding)) ++first_;
    for (std::size_t i = first_ + 1; i < kSteps.size(); ++i)
      if (!(off(z, kSteps[i]) <= rounding)) out_[i] = true;
    while (first_ < kSteps.size() && out_[first_]) ++first_;
  }
  double step() const { return first_ < kSteps.size() ? kSteps[first_] : 0.0; }

 private:
  static double off(double z, double step) { return std::abs(z - step * std::round(z / step)); }

  static constexpr std::array<double, 12> kSteps{10.0, 5.0, 2.0, 1.0, 0.5, 0.3048, 0.25, 0.2, 0.1, 0.05, 0.02, 0.01};
  std::array<bool, kSteps.size()> out_{};  // heights that are no multiples were seen
  std::size_t first_ = 0;                  // the largest that is left
};

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

DemFigures dem_figures(const Raster<float>& heights) {
  constexpr std::uint64_t kSample = 1'000'000;
  const double steep = std::tan(radians(80.0));
  const Grid& grid = heights.grid;
  const int stride = static_cast<int>(1 + grid.cells() / kSample);
  std::vector<float> tangents;
  std::uint64_t steeper = 0, flat = 0, threes = 0, bends = 0;
  StepFinder steps;
  for (int row = 1; row + 1 < grid.rows; row += stride) {
    heights.values.memory().keep_below_limit();
    for (int column = 1; column + 1 < grid.columns; ++column) {
      const float west = heights.at(column - 1, row), z = heights.at(column, row), east = heights.at(column + 1, row);
      if (std::isnan(z)) continue;
      steps.add(z);
      const double bend = double{west} - 2.0 * double{z} + double{east};
      if (!std::isnan(bend)) ++threes, bends += bend != 0.0 ? 1U : 0U;
      const double tangent = horn_slope(heights, column, row);
      if (std::isnan(tangent)) continue;
      tangents.push_back(static_cast<float>(tangent));
      steeper += tangent > steep ? 1U : 0U;
      flat += tangent == 0.0 ? 1U : 0U;
    }
  }
  DemFigures figures;
  figures.cells = tangents.size();
  if (tangents.empty()) return figures;
  const auto middle = tangents.begin() + static_cast<std::ptrdiff_t>(tangents.size() / 2);
  std::nth_element(tangents.begin(), middle, tangents.end());
  figures.median_slope = std::atan(double{*middle});
  figures.steep_share = share(steeper, figures.cells);
  figures.flat_share = share(flat, figures.cells);
  figures.step = steps.step();
  figures.bend_share = share(bends, threes);
  return figures;
}

}  // namespace talus
