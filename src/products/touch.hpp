#pragma once
#include <Eigen/Core>
#include <optional>

namespace talus {

/// A straight way in plan [m].
struct Way {
  Eigen::Vector2d from, to;
};

/// The first and the last share of a way, 0 to 1, at which it is in touch with something.
struct Touch {
  double first, last;
};

/// The part of a way that lies within a distance of a straight line between two points [m]; nothing if it keeps away.
/// The points within that distance are convex (a rectangle with round ends), so that the part is in one piece. Closed
/// form.
std::optional<Touch> touch_of(const Way& way, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double distance);

/// From the first to the last share of two touches.
std::optional<Touch> hull(const std::optional<Touch>& a, const std::optional<Touch>& b);

}  // namespace talus
