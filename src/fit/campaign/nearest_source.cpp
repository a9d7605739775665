#include "nearest_source.hpp"

#include <limits>

namespace talus {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// The row of the nearest source in the same column, for every cell; -1: the column has none.
std::vector<int> nearest_rows(const Raster<std::uint32_t>& sources) {
  const Grid& grid = sources.grid;
  std::vector<int> nearest(grid.cells(), -1);
  for (int column = 0; column < grid.columns; ++column) {
    int last = -1;
    for (int row = 0; row < grid.rows; ++row) {
      if (sources.at(column, row) != kNoSource) last = row;
      nearest[grid.index(column, row)] = last;
    }
    last = -1;
    for (int row = grid.rows - 1; row >= 0; --row) {
      if (sources.at(column, row) != kNoSource) last = row;
      int& below = nearest[grid.index(column, row)];
      if (below < 0 || (last >= 0 && last - row < row - below)) below = last;
    }
  }
  return nearest;
}

/// The lower envelope of the parabolas (x - column)^2 + f(column), of which each row of cells has one.
class Envelope {
 public:
  /// @param height  f, infinite where there is no parabola [m2]
  void build(const std::vector<double>& height, double cell) {
    columns_.clear();
    from_.clear();
    for (int column = 0; column < static_cast<int>(height.size()); ++column) {
      if (height[static_cast<std::size_t>(column)] == kFar) continue;
      double begin = -kFar;
      while (!columns_.empty()) {
        begin = crossing(columns_.back(), column, height, cell);
        if (begin > from_.back()) break;
        columns_.pop_back();
        from_.pop_back();
        begin = -kFar;
      }
      columns_.push_back(column);
      from_.push_back(begin);
    }
  }

  /// Calls `visit(column, lowest)` for each column, `lowest` being that of the lowest parabola there.
  template <class Visit>
  void for_each(int columns, double cell, Visit visit) const {
    std::size_t piece = 0;
    for (int column = 0; column < columns; ++column) {
      while (piece + 1 < columns_.size() && from_[piece + 1] < column * cell) ++piece;
      visit(column, columns_[piece]);
    }
  }

 private:
  static double crossing(int a, int b, const std::vector<double>& height, double cell) {
    const double x = a * cell, y = b * cell;
    return ((height[static_cast<std::size_t>(b)] + y * y) - (height[static_cast<std::size_t>(a)] + x * x)) /
           (2.0 * (y - x));
  }

  std::vector<int> columns_;
  std::vector<double> from_;  // where each parabola becomes the lowest [m]
};

}  // namespace

Raster<std::uint32_t> nearest_sources(const Raster<std::uint32_t>& sources) {
  const Grid& grid = sources.grid;
  const std::vector<int> rows = nearest_rows(sources);
  Raster<std::uint32_t> nearest(grid, kNoSource);
  std::vector<double> height(static_cast<std::size_t>(grid.columns));
  Envelope envelope;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const int source = rows[grid.index(column, row)];
      const double away = (row - source) * grid.cell_y;
      height[static_cast<std::size_t>(column)] = source < 0 ? kFar : away * away;
    }
    envelope.build(height, grid.cell_x);
    envelope.for_each(grid.columns, grid.cell_x, [&](int column, int lowest) {
      nearest.at(column, row) = sources.at(lowest, rows[grid.index(lowest, row)]);
    });
  }
  return nearest;
}

}  // namespace talus
