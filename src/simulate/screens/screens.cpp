#include "talus/simulate/screens/screens.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

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
  std::vector<LinePiece> pieces;
  append_pieces(0, screen.lines, pieces);
  double found = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (const LinePiece& piece : pieces) {
    const Eigen::Vector2d way = piece.to - piece.from;
    const double length = way.norm();
    const double share = length > 0.0 ? std::clamp(way.dot(place - piece.from) / (length * length), 0.0, 1.0) : 0.0;
    const double distance = (piece.from + share * way - place).norm();
    if (distance < nearest) nearest = distance, found = piece.along + share * length;
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
  for (std::uint32_t s = 0; s < screens.size(); ++s) append_pieces(s, screens[s].lines, pieces_);
  for (const LinePiece& piece : pieces_) {
    low_ = low_.cwiseMin(piece.from).cwiseMin(piece.to);
    high_ = high_.cwiseMax(piece.from).cwiseMax(piece.to);
  }
}

void ScreenFinder::find(const Release& release, const Path& path, std::vector<Crossing>& crossings) const {
  if (pieces_.empty()) return;
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

void ScreenFinder::cross(const Release& release, const Block& body, const Vertex& from, const Vertex& to,
                         std::vector<Crossing>& crossings) const {
  const Eigen::Vector2d a = from.motion.position.head<2>(), b = to.motion.position.head<2>(), way = b - a;
  const std::size_t first = crossings.size();
  for (const LinePiece& piece : pieces_) {
    const std::optional<WayCrossing> crossing = crossing_of(a, b, piece);
    if (!crossing) continue;
    const Eigen::Vector2d line = piece.to - piece.from;
    // On the line of a barrier that broke: with what the barrier left, whichever way rounding puts the crossing on.
    const bool behind = to.event == Event::Barrier && (1.0 - crossing->share) * way.norm() <= kOneLine;
    const Motion m = behind ? to.motion : motion_between(from, to, crossing->share);
    const double ground = surface_.height(m.position.x(), m.position.y()).value_or(m.position.z());
    crossings.push_back({release.source, release.block, piece.owner, release.piece, m.position.x(), m.position.y(),
                         m.velocity.norm(), from.event == Event::Slide ? 0.0 : std::max(0.0, m.position.z() - ground),
                         m.spin.norm(), body.mass, body.diameter, crossing->along, m.time,
                         std::atan2(-m.velocity.z(), m.velocity.head<2>().norm()),
                         std::atan2(std::abs(way.dot(line)), std::abs(cross_product(way, line)))});
  }
  std::sort(crossings.begin() + static_cast<std::ptrdiff_t>(first), crossings.end(),
            [](const Crossing& l, const Crossing& r) { return l.time < r.time; });
}

}  // namespace talus
