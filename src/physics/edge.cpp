#include "edge.hpp"

#include <algorithm>

namespace talus {
namespace {

constexpr double kLargestShare = 0.25;  // of a cell, per piece: the twist of the patches may end the crease

/// The edge between two patches, or the crease of one: a straight line in space.
struct Edge {
  Vec3 direction;  // unit, towards north or east
  double length;   // of the whole edge, in space [m]
  double share;    // position of the block along it, 0..1
};

/// The crease of the patch, towards east.
Edge crease_edge(const Slope& slope, const Eigen::Vector2d& place) {
  const Grid& grid = slope.surface.grid();
  const double sign = slope.crease == Crease::Rising ? 1.0 : -1.0;
  const Vec3 direction(grid.cell_x, sign * grid.cell_y, slope.patch.east + sign * slope.patch.north);
  const double length = direction.norm();
  return {direction / length, length, slope.p_of(place)};
}

Edge edge_between(const Slope& slope, const Slope& beyond, const Eigen::Vector2d& place) {
  if (slope.at == beyond.at) return crease_edge(slope, place);
  const Grid& grid = slope.surface.grid();
  const bool northward = slope.at.row == beyond.at.row;
  const bool far_side = northward ? beyond.at.column > slope.at.column : beyond.at.row > slope.at.row;
  const double twist = far_side ? slope.whole.twist : 0.0;  // at a corner the edge may belong to the other half
  const double plan = northward ? grid.cell_y : grid.cell_x;
  const double rise = (northward ? slope.whole.north : slope.whole.east) + twist;
  const double length = std::sqrt(plan * plan + rise * rise);
  const Vec3 direction = northward ? Vec3(0.0, plan, rise) : Vec3(plan, 0.0, rise);
  return {direction / length, length, northward ? slope.q_of(place) : slope.p_of(place)};
}

/// The share of an edge from the block to its end, or to the border of two cells in its middle if friction changes
/// there.
double share_ahead(const Slope& slope, double share, double sign) {
  const bool ends_in_the_middle = slope.bounded_to && in_far_half(share, sign) != (sign > 0.0);
  const double end = ends_in_the_middle ? 0.5 : sign > 0.0 ? 1.0 : 0.0;
  return std::max(0.0, sign * (end - share));
}

double cosine_of_slope(const Slope& slope, const Eigen::Vector2d& place) {
  return 1.0 / std::sqrt(1.0 + slope.gradient(place).squaredNorm());
}

}  // namespace

EdgeEnd slide_along_edge(const Slope& slope, const Slope& beyond, Motion& motion, double farthest, Path& path) {
  const Eigen::Vector2d place = motion.position.head<2>();
  const Edge edge = edge_between(slope, beyond, place);
  const double speed = motion.velocity.norm(), ahead = motion.velocity.dot(edge.direction);
  double sign = ahead < 0.0 ? -1.0 : 1.0;
  if (!(std::abs(ahead) > 1e-9 * speed)) {                // no velocity along the edge: downwards
    if (edge.direction.z() == 0.0) return EdgeEnd::Held;  // level: nothing pulls it to either side
    sign = edge.direction.z() > 0.0 ? -1.0 : 1.0;
  }
  const double friction =
      slope.tan_phi * kGravity * 0.5 * (cosine_of_slope(slope, place) + cosine_of_slope(beyond, place));
  const double pull = -sign * kGravity * edge.direction.z() - friction;
  if (!(speed > 0.0) && !(pull > 0.0)) return EdgeEnd::Held;

  const double to_end = edge.length * share_ahead(slope, edge.share, sign);
  const double way = std::min({to_end, farthest, kLargestShare * edge.length});
  double duration = time_to_cover(way, speed, pull, kLongestPiece);
  if (pull < 0.0) duration = std::min(duration, speed / -pull);  // comes to rest earlier
  Motion turned = motion, next = motion;
  turned.velocity = sign * speed * edge.direction;
  const double distance = std::clamp(duration * (speed + 0.5 * pull * duration), 0.0, to_end);
  next.time += duration;
  next.position += sign * distance * edge.direction;
  next.velocity = sign * std::max(0.0, speed + pull * duration) * edge.direction;
  record_piece(path, slope, turned, next);
  motion = next;
  return EdgeEnd::Moved;
}

}  // namespace talus
