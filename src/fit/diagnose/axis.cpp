#include "talus/fit/diagnose/axis.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "talus/base/sample.hpp"

namespace talus {

Axis axis_of(const Campaign& campaign, std::span<const BlockRuns> runs) {
  Eigen::Vector2d release = Eigen::Vector2d::Zero(), stop = release;
  double stops = 0.0, released = 0.0;
  for (const MeasuredBlock& block : campaign.blocks)
    if (!block.holdout) release += Eigen::Vector2d(block.x, block.y), released += 1.0;
  release /= released;
  std::vector<Eigen::Vector2d> ends;
  for (const BlockRuns& r : runs) std::ranges::copy(stops_of(r), std::back_inserter(ends));
  for (const MeasuredBlock& block : campaign.blocks)
    if (!block.holdout && block.stop) ends.push_back(*block.stop);
  for (const Eigen::Vector2d& end : ends) stop += end, stops += 1.0;
  Axis axis{release, Eigen::Vector2d::UnitX(), 0.0, 1.0};
  if (stops == 0.0 || (stop / stops - release).norm() == 0.0) return axis;
  axis.direction = (stop / stops - release).normalized();
  std::vector<double> reached;
  for (const Eigen::Vector2d& end : ends) reached.push_back(axis.along(end));
  std::sort(reached.begin(), reached.end());
  axis.to = std::max(1.0, quantile(reached, 0.95));
  return axis;
}

}  // namespace talus
