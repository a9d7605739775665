#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "talus/base/vector.hpp"
#include "talus/terrain/raster.hpp"

/// Helpers of several tests: random numbers that are not the engine's, terrain from a formula, moments.
namespace talus::test {

inline const double kTan30 = 1.0 / std::sqrt(3.0);

constexpr double kEps = 2.220446049250313e-16;

/// Random numbers that are the same on every platform and do not use talus/base/random.hpp.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  double uniform(double from, double to) {
    return from + (to - from) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  double normal() {
    return std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0))) * std::cos(2.0 * kPi * uniform(0.0, 1.0));
  }
  Vec3 vector(double scale) {
    const double x = normal(), y = normal(), z = normal();
    return scale * Vec3(x, y, z);
  }

 private:
  std::mt19937_64 engine_;
};

inline Grid grid_of(int columns, int rows, double cell_x, double cell_y) {
  Grid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.cell_x = cell_x;
  grid.cell_y = cell_y;
  return grid;
}

/// Heights z = f(x, y) at the cell centres. Slopes and cells that are short binary fractions keep floats exact.
template <class F>
Raster<float> terrain(const Grid& grid, F f) {
  Raster<float> heights(grid, 0.0F);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      heights.at(column, row) = static_cast<float>(f((column + 0.5) * grid.cell_x, (row + 0.5) * grid.cell_y));
  return heights;
}

/// Bilinear interpolation between the cell centres by the textbook's weights: a second implementation of the surface.
inline double height_between_centres(const Raster<float>& heights, double x, double y) {
  const double u = x / heights.grid.cell_x - 0.5, v = y / heights.grid.cell_y - 0.5;
  const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
  const double p = u - column, q = v - row;
  const double south = (1.0 - p) * heights.at(column, row) + p * heights.at(column + 1, row);
  const double north = (1.0 - p) * heights.at(column, row + 1) + p * heights.at(column + 1, row + 1);
  return (1.0 - q) * south + q * north;
}

/// The creased surface by its definition: in a patch whose lowest corner lies on a diagonal along which the bilinear
/// patch rises from its higher end, the two triangles that meet in that diagonal; else the bilinear patch. A second
/// implementation of the surface.
inline double height_on_creases(const Raster<float>& heights, double x, double y) {
  const double u = x / heights.grid.cell_x - 0.5, v = y / heights.grid.cell_y - 0.5;
  const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
  const double p = u - column, q = v - row;
  const double sw = heights.at(column, row), se = heights.at(column + 1, row), nw = heights.at(column, row + 1),
               ne = heights.at(column + 1, row + 1), lowest = std::min({sw, se, nw, ne});
  if (0.5 * (se + nw) > std::max(sw, ne) && lowest == std::min(sw, ne))  // by the weights of the corners of a triangle
    return p >= q ? (1.0 - p) * sw + (p - q) * se + q * ne : (1.0 - q) * sw + (q - p) * nw + p * ne;
  if (0.5 * (sw + ne) > std::max(se, nw) && lowest == std::min(se, nw))
    return p + q <= 1.0 ? (1.0 - p - q) * sw + p * se + q * nw : (p + q - 1.0) * ne + (1.0 - p) * nw + (1.0 - q) * se;
  return height_between_centres(heights, x, y);
}

/// Outward unit normal of a slope of an angle [degrees] that dips towards an azimuth in plan [radians from east].
inline Vec3 slope_normal(double angle, double azimuth) {
  const double beta = radians(angle);
  return {std::sin(beta) * std::cos(azimuth), std::sin(beta) * std::sin(azimuth), std::cos(beta)};
}

/// Mean and its standard error.
struct Moments {
  double count = 0.0, sum = 0.0, squares = 0.0;
  void add(double x) { count += 1.0, sum += x, squares += x * x; }
  double mean() const { return sum / count; }
  double error() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / count); }
};

}  // namespace talus::test
