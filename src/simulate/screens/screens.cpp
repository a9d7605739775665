#include "talus/simulate/screens/screens.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

double cross_product(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The part of a line between two distances from its start [m].
std::vector<Eigen::Vector2d> part_of(const std::vector<Eigen::Vector2d>& line, double from, double to) {
  std::vector<Eigen::Vector2d> part;
  double along = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector2d way = line[i] - line[i - 1];
    const double length = way.norm(), first = std::max(from, along), last = std::min(to, along + length);
    if (first < last) {
      if (part.empty()) part.emplace_back(line[i - 1] + (first - along) / length * way);
      part.emplace_back(line[i - 1] + (last - along) / length * way);
    }
    along += length;
  }
  return part;
}

}  // namespace

double place_along(const Screen& screen, const Eigen::Vector2d& place) {
  double along = 0.0, found = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (const auto& line : screen.lines)
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Eigen::Vector2d way = line[i] - line[i - 1];
      const double length = way.norm();
      const double share = length > 0.0 ? std::clamp(way.dot(place - line[i - 1]) / (length * length), 0.0, 1.0) : 0.0;
      const double distance = (line[i - 1] + share * way - place).norm();
      if (distance < nearest) nearest = distance, found = along + share * length;
      along += length;
    }
  return found;
}

double length_of(const std::vector<Eigen::Vector2d>& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

std::vector<Eigen::Vector2d> part_along(const Screen& screen, double from, double to) {
  double start = 0.0;
  for (const auto& line : screen.lines) {
    const double end = start + length_of(line);
    if (0.5 * (from + to) < end) return part_of(line, from - start, to - start);
    start = end;
  }
  return {};
}

ScreenFinder::ScreenFinder(const Surface& surface, std::span<const Screen> screens) : surface_(surface) {
  low_.setConstant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  for (std::uint32_t s = 0; s < screens.size(); ++s) {
    double along = 0.0;
    for (const auto& line : screens[s].lines) {
      for (std::size_t i = 1; i < line.size(); ++i) {
        segments_.push_back({s, line[i - 1], line[i], along});
        along += (line[i] - line[i - 1]).norm();
        low_ = low_.cwiseMin(line[i - 1]).cwiseMin(line[i]);
        high_ = high_.cwiseMax(line[i - 1]).cwiseMax(line[i]);
      }
    }
  }
}

void ScreenFinder::find(const Release& release, const Path& path, std::vector<Crossing>& crossings) const {
  if (segments_.empty()) return;
  Block body = release.body;
  auto broken = path.breaks.begin();
  for (std::size_t i = 1; i < path.vertices.size(); ++i) {
    for (; broken != path.breaks.end() && broken->vertex < i; ++broken) body = broken->body;
    const Vertex &from = path.vertices[i - 1], &to = path.vertices[i];
    const Eigen::Vector2d a = from.motion.position.head<2>(), b = to.motion.position.head<2>();
    if ((a.cwiseMax(b).array() < low_.array()).any() || (a.cwiseMin(b).array() > high_.array()).any()) continue;
    cross(release, body, from, to, crossings);
  }
}

/// A way crosses a segment if its ends lie on different sides of the segment, and the ends of the segment on different
/// sides of the way. A point on the line itself counts to one fixed side, so that a path through a vertex of the path
/// or of the screen is counted once.
void ScreenFinder::cross(const Release& release, const Block& body, const Vertex& from, const Vertex& to,
                         std::vector<Crossing>& crossings) const {
  const Eigen::Vector2d a = from.motion.position.head<2>(), b = to.motion.position.head<2>(), way = b - a;
  const std::size_t first = crossings.size();
  for (const Segment& s : segments_) {
    const Eigen::Vector2d line = s.to - s.from;
    const double side_from = cross_product(line, a - s.from), side_to = cross_product(line, b - s.from);
    if ((side_from < 0.0) == (side_to < 0.0)) continue;
    const double low = cross_product(way, s.from - a), high = cross_product(way, s.to - a);
    if ((low < 0.0) == (high < 0.0)) continue;
    const double share = side_from / (side_from - side_to);
    // On the line of a barrier that broke: with what the barrier left, whichever way rounding puts the crossing on.
    const bool behind = to.event == Event::Barrier && (1.0 - share) * way.norm() <= kOneLine;
    const Motion m = behind ? to.motion : motion_between(from, to, share);
    const double ground = surface_.height(m.position.x(), m.position.y()).value_or(m.position.z());
    crossings.push_back({release.source, release.block, s.screen, release.piece, m.position.x(), m.position.y(),
                         m.velocity.norm(), from.event == Event::Slide ? 0.0 : std::max(0.0, m.position.z() - ground),
                         m.spin.norm(), body.mass, body.diameter, s.along + line.norm() * (low / (low - high)), m.time,
                         std::atan2(-m.velocity.z(), m.velocity.head<2>().norm()),
                         std::atan2(std::abs(way.dot(line)), std::abs(cross_product(way, line)))});
  }
  std::sort(crossings.begin() + static_cast<std::ptrdiff_t>(first), crossings.end(),
            [](const Crossing& l, const Crossing& r) { return l.time < r.time; });
}

}  // namespace talus
