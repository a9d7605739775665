#pragma once
#include "talus/fit/diagnose/candidates.hpp"

/// What a campaign does not say of its place: other ground in a band, a barrier. docs/closing-the-loop.md,
/// "Candidates".
namespace talus {

/// Positions along the slope: the direction in plan in which the blocks of a campaign go, and how far.
struct Axis {
  Eigen::Vector2d origin, direction;  ///< [m, local], unit
  double from = 0.0, to = 0.0;        ///< of the paths, along the direction from the origin [m]

  double along(const Eigen::Vector2d& place) const { return (place - origin).dot(direction); }
};

/// From the mean release to the mean simulated stop.
Axis axis_of(const Campaign& campaign, std::span<const BlockRuns> runs);

/// A band of other ground across the axis, from one distance along it to another [m].
Candidate band(const Campaign& campaign, const Axis& axis, double from, double to);
/// A barrier across the axis that takes any energy, at a distance along it.
///
/// @param width  half of its length [m]
Candidate barrier(const Axis& axis, double width, double at);

}  // namespace talus
