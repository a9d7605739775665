#include "touch.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

using Eigen::Vector2d;

std::optional<Touch> on_the_way(double first, double last) {
  const Touch touch{std::max(0.0, first), std::min(1.0, last)};
  return touch.first <= touch.last ? std::optional(touch) : std::nullopt;
}

/// Shares at which low <= value + share * change <= high.
std::optional<Touch> between(double low, double high, double value, double change) {
  if (change == 0.0) return value >= low && value <= high ? on_the_way(0.0, 1.0) : std::nullopt;
  const double a = (low - value) / change, b = (high - value) / change;
  return on_the_way(std::min(a, b), std::max(a, b));
}

std::optional<Touch> in_disc(const Way& way, const Vector2d& centre, double radius) {
  const Vector2d along = way.to - way.from, from = way.from - centre;
  const double a = along.squaredNorm(), b = along.dot(from), c = from.squaredNorm() - radius * radius;
  if (a == 0.0) return c <= 0.0 ? on_the_way(0.0, 1.0) : std::nullopt;
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0.0)) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return on_the_way((-b - root) / a, (-b + root) / a);
}

/// Within the rectangle along a line, without its round ends.
std::optional<Touch> in_rectangle(const Way& way, const Vector2d& a, const Vector2d& b, double distance) {
  const Vector2d line = b - a, along = way.to - way.from, from = way.from - a;
  const double length = line.norm();
  if (length == 0.0) return std::nullopt;
  const Vector2d t = line / length, n(-t.y(), t.x());
  const auto lengthwise = between(0.0, length, t.dot(from), t.dot(along)),
             across = between(-distance, distance, n.dot(from), n.dot(along));
  if (!lengthwise || !across) return std::nullopt;
  return on_the_way(std::max(lengthwise->first, across->first), std::min(lengthwise->last, across->last));
}

/// Whether the boxes around both are farther apart than the distance.
bool apart(const Way& way, const Vector2d& a, const Vector2d& b, double distance) {
  const Vector2d low = way.from.cwiseMin(way.to), high = way.from.cwiseMax(way.to);
  return ((low - a.cwiseMax(b)).array() > distance).any() || ((a.cwiseMin(b) - high).array() > distance).any();
}

}  // namespace

std::optional<Touch> hull(const std::optional<Touch>& a, const std::optional<Touch>& b) {
  if (!a || !b) return a ? a : b;
  return Touch{std::min(a->first, b->first), std::max(a->last, b->last)};
}

std::optional<Touch> touch_of(const Way& way, const Vector2d& a, const Vector2d& b, double distance) {
  if (apart(way, a, b, distance)) return std::nullopt;
  return hull(in_rectangle(way, a, b, distance), hull(in_disc(way, a, distance), in_disc(way, b, distance)));
}

}  // namespace talus
