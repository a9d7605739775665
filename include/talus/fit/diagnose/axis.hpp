#pragma once
#include "talus/fit/campaign/observe.hpp"

namespace talus {

/// Positions along the slope: the direction in plan in which the blocks of a campaign go, and how far.
struct Axis {
  Eigen::Vector2d origin, direction;  ///< [m, local], unit
  double from = 0.0, to = 0.0;        ///< of the paths, along the direction from the origin [m]

  double along(const Eigen::Vector2d& place) const { return (place - origin).dot(direction); }
};

/// The axis from the mean release to the mean simulated stop.
Axis axis_of(const Campaign& campaign, std::span<const BlockRuns> runs);

}  // namespace talus
