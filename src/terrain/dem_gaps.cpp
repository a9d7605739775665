#include "talus/terrain/dem_gaps.hpp"

#include <cmath>
#include <vector>

namespace talus {

bool DemGaps::is_missing(int column, int row) const {
  return std::isnan(heights_.at(column, row));
}

bool DemGaps::is_outer(const Run& run) const {
  const Grid& grid = heights_.grid;
  return run.row == 0 || run.row == grid.rows - 1 || run.first == 0 || run.last == grid.columns - 1;
}

DemGaps::Run DemGaps::run_at(int column, int row) const {
  Run run{row, column, column};
  while (run.first > 0 && is_missing(run.first - 1, row)) --run.first;
  while (run.last + 1 < heights_.grid.columns && is_missing(run.last + 1, row)) ++run.last;
  return run;
}

bool DemGaps::is_enclosed(const Run& run) {
  if (const auto known = enclosed_.find(key(run)); known != enclosed_.end()) return known->second;
  std::vector<Run> open{run};
  std::vector<std::size_t> connected{key(run)};
  enclosed_[key(run)] = true;
  bool enclosed = true;
  while (enclosed && !open.empty()) {
    const Run from = open.back();
    open.pop_back();
    heights_.values.memory().keep_below_limit();
    enclosed = !is_outer(from);
    if (!enclosed) break;
    for (const int row : {from.row - 1, from.row + 1})
      for (int column = from.first - 1; column <= from.last + 1; ++column) {
        if (!is_missing(column, row)) continue;
        const Run next = run_at(column, row);
        column = next.last;
        const auto [before, is_new] = enclosed_.try_emplace(key(next), true);
        if (!before->second) enclosed = false;  // an earlier search from there has reached an outer row or column
        if (!is_new) continue;
        open.push_back(next);
        connected.push_back(key(next));
      }
  }
  if (!enclosed)
    for (const std::size_t one : connected) enclosed_[one] = false;
  return enclosed;
}

bool DemGaps::beside(int column, int row) {
  heights_.values.memory().keep_below_limit();
  bool found = false;
  for (int r = row - 1; r <= row + 1; ++r)
    for (int c = column - 1; c <= column + 1; ++c) {
      if (!heights_.grid.contains(c, r)) return false;
      if (!is_missing(c, r)) continue;
      if (!is_enclosed(run_at(c, r))) return false;
      found = true;
    }
  return found;
}

}  // namespace talus
