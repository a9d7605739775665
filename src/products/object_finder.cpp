#include "object_finder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "talus/physics/span_speed.hpp"

namespace talus {
namespace {

constexpr double kBeyondEdge = 1e-6;  // share of a way by which the rim has surely left what it just touched

/// Whether a point lies within the outer ring and in no hole: rays to the east cross the rings an odd number of times.
bool contains(const std::vector<HazardObject::Ring>& rings, const Eigen::Vector2d& p) {
  bool inside = false;
  for (const HazardObject::Ring& ring : rings)
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Eigen::Vector2d &a = ring[i], &b = ring[j];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
  return inside;
}

std::optional<Touch> touch_of_line(const Way& way, const HazardObject::Ring& points, double distance) {
  std::optional<Touch> touch;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    touch = hull(touch, touch_of(way, points[i], points[i + 1], distance));
  return touch;
}

Eigen::AlignedBox2d box_of(const HazardObject& object) {
  Eigen::AlignedBox2d box;
  for (const auto& rings : object.polygons)
    for (const Eigen::Vector2d& p : rings[0]) box.extend(p);
  for (const HazardObject::Ring& line : object.lines)
    for (const Eigen::Vector2d& p : line) box.extend(p);
  return box;
}

}  // namespace

std::optional<Touch> touch_of(const Way& way, const HazardObject& object, double radius) {
  std::optional<Touch> touch;
  for (const auto& rings : object.polygons) {
    for (const HazardObject::Ring& ring : rings) touch = hull(touch, touch_of_line(way, ring, radius));
    if (contains(rings, way.from)) touch = hull(touch, Touch{0.0, 0.0});
    if (contains(rings, way.to)) touch = hull(touch, Touch{1.0, 1.0});
  }
  for (const HazardObject::Ring& line : object.lines)
    touch = hull(touch, touch_of_line(way, line, radius + 0.5 * object.line_width));
  return touch;
}

ObjectFinder::ObjectFinder(const Surface& surface, std::span<const HazardObject> objects, double radius)
    : surface_(surface), objects_(objects), near_(surface.grid(), 0) {
  for (std::uint32_t object = 0; object < objects.size(); ++object) enter(object, radius);
}

/// Adds an object to the list of each patch from which a block of this radius may touch it.
void ObjectFinder::enter(std::uint32_t number, double radius) {
  const HazardObject& object = objects_[number];
  const Eigen::AlignedBox2d box = box_of(object);
  const double margin = radius + 0.5 * object.line_width;
  const Grid& grid = surface_.grid();
  const auto clamped = [](double value, int last) { return static_cast<int>(std::clamp(value, 0.0, double(last))); };
  const int west = clamped(surface_.u_of(box.min().x() - margin), grid.columns - 1),
            east = clamped(surface_.u_of(box.max().x() + margin), grid.columns - 1),
            south = clamped(surface_.v_of(box.min().y() - margin), grid.rows - 1),
            north = clamped(surface_.v_of(box.max().y() + margin), grid.rows - 1);
  const double reach = radius + 0.5 * std::hypot(grid.cell_x, grid.cell_y);  // from the centre of a patch
  for (int row = south; row <= north; ++row)
    for (int column = west; column <= east; ++column) {
      const Eigen::Vector2d middle(surface_.x_of(column + 0.5), surface_.y_of(row + 0.5));
      if (!touch_of({middle, middle}, object, reach)) continue;
      std::int32_t& list = near_.at(column, row);
      if (list == 0) {
        lists_.emplace_back();
        list = static_cast<std::int32_t>(lists_.size());
      }
      lists_[static_cast<std::size_t>(list) - 1].push_back(number);
    }
}

Way ObjectFinder::way_of(const Span& span) const {
  const auto place = [&](float p, float q) {
    return Eigen::Vector2d(surface_.x_of(span.patch.column + double{p}), surface_.y_of(span.patch.row + double{q}));
  };
  return {place(span.p_from, span.q_from), place(span.p_to, span.q_to)};
}

std::span<const std::uint32_t> ObjectFinder::objects_near(const Span& span) const {
  if (!near_.grid.contains(span.patch.column, span.patch.row)) return {};
  const std::int32_t list = near_.at(span.patch.column, span.patch.row);
  if (list == 0) return {};
  return lists_[static_cast<std::size_t>(list) - 1];
}

bool ObjectFinder::only_rim_touches(std::uint32_t object, const Eigen::Vector2d& place, double radius) const {
  const Way there{place, place};
  return touch_of(there, objects_[object], radius) && !touch_of(there, objects_[object], 0.0);
}

ObjectFinder::RimLimits ObjectFinder::limits_of(const Path& path, const Block& first, const Block& last) const {
  RimLimits limits;
  const auto& spans = path.spans;
  if (spans.empty()) return limits;
  for (const std::uint32_t object : objects_near(spans.front())) {
    if (!only_rim_touches(object, way_of(spans.front()).from, first.radius())) continue;
    PlaceOnPath left{spans.size(), 0.0};  // where the rim leaves the object
    for (std::size_t i = 0; i < spans.size() && left.span == spans.size(); ++i) {
      const auto touch = touch_of(way_of(spans[i]), objects_[object], first.radius());
      if (!touch || touch->first > 0.0)
        left = {i, 0.0};
      else if (touch->last < 1.0)
        left = {i, std::min(1.0, touch->last + kBeyondEdge)};
    }
    limits.begin.emplace_back(object, left);
  }
  if (path.end != End::Caught) return limits;
  for (const std::uint32_t object : objects_near(spans.back())) {
    if (!only_rim_touches(object, way_of(spans.back()).to, last.radius())) continue;
    PlaceOnPath reached{0, 0.0};  // where the rim touches the object for good
    for (std::size_t i = spans.size(); i-- > 0;) {
      const auto touch = touch_of(way_of(spans[i]), objects_[object], last.radius());
      if (touch && touch->last >= 1.0 && touch->first <= 0.0) continue;
      reached = {i, touch && touch->last >= 1.0 ? std::max(0.0, touch->first - kBeyondEdge) : 1.0};
      break;
    }
    limits.end.emplace_back(object, reached);
  }
  return limits;
}

void ObjectFinder::add(const Way& way, const Stretch& part, double radius, std::uint32_t object, const Span& span,
                       const Block& body, ObjectContact& contact) const {
  if (!(part.from < part.to)) return;
  const Eigen::Vector2d whole = way.to - way.from;
  const auto touch = touch_of({way.from + part.from * whole, way.from + part.to * whole}, objects_[object], radius);
  if (!touch) return;
  const auto energy = [&](double share) {
    const double place = part.from + share * (part.to - part.from);
    return static_cast<float>(0.5e-3 * body.mass * speed_squared_at(span, place));
  };
  if (contact.entry < 0.0F) contact.entry = energy(touch->first);
  contact.largest = std::max({contact.largest, energy(touch->first), energy(touch->last)});
}

void ObjectFinder::add(const Path& path, const Block& body, std::span<ObjectContact> contacts) const {
  const RimLimits limits = limits_of(path, body, path.breaks.empty() ? body : path.breaks.back().body);
  Block block = body;
  auto next_break = path.breaks.begin();
  for (std::size_t i = 0; i < path.spans.size(); ++i) {
    for (; next_break != path.breaks.end() && next_break->span <= i; ++next_break) block = next_break->body;
    const Span& span = path.spans[i];
    const std::span<const std::uint32_t> near = objects_near(span);
    if (near.empty()) continue;
    const Way way = way_of(span);
    for (const std::uint32_t object : near) {
      const Stretch rim = limits.of_rim(object, i);
      add(way, {0.0, rim.from}, 0.0, object, span, block, contacts[object]);
      add(way, rim, block.radius(), object, span, block, contacts[object]);
      add(way, {std::max(rim.from, rim.to), 1.0}, 0.0, object, span, block, contacts[object]);
    }
  }
}

Stretch ObjectFinder::RimLimits::of_rim(std::uint32_t object, std::size_t span) const {
  Stretch rim;
  for (const auto& [number, place] : begin)
    if (number == object && span <= place.span) rim.from = span < place.span ? 1.0 : place.share;
  for (const auto& [number, place] : end)
    if (number == object && span >= place.span) rim.to = span > place.span ? 0.0 : place.share;
  return rim;
}

}  // namespace talus
