#include "object_finder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "talus/physics/span_speed.hpp"

namespace talus {
namespace {

constexpr double kBeyondEdge = 1e-6;  // way on which a rim has surely left what it just touched [m]

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

Eigen::AlignedBox2d box_of(const HazardObject& object) {
  Eigen::AlignedBox2d box;
  for (const auto& rings : object.polygons)
    for (const Eigen::Vector2d& p : rings[0]) box.extend(p);
  for (const HazardObject::Ring& line : object.lines)
    for (const Eigen::Vector2d& p : line) box.extend(p);
  return box;
}

std::size_t parts_of(const HazardObject& object) {
  return object.polygons.size() + object.lines.size();
}

/// Calls `visit(a, b, distance)` for each edge of a part of an object, with the distance at which a block touches it.
template <class Visit>
void for_each_edge(const HazardObject& object, std::size_t part, double radius, Visit visit) {
  const auto visit_line = [&](const HazardObject::Ring& points, double distance) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) visit(points[i], points[i + 1], distance);
  };
  if (part < object.polygons.size())
    for (const HazardObject::Ring& ring : object.polygons[part]) visit_line(ring, radius);
  else
    visit_line(object.lines[part - object.polygons.size()], radius + 0.5 * object.line_width);
}

std::optional<Touch> touch_of_part(const Way& way, const HazardObject& object, std::size_t part, double radius) {
  std::optional<Touch> touch;
  for_each_edge(object, part, radius, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double distance) {
    touch = hull(touch, touch_of(way, a, b, distance));
  });
  if (part >= object.polygons.size()) return touch;
  if (contains(object.polygons[part], way.from)) touch = hull(touch, Touch{0.0, 0.0});
  if (contains(object.polygons[part], way.to)) touch = hull(touch, Touch{1.0, 1.0});
  return touch;
}

/// The share of a way at which a rim that touches the edges of a part at its beginning leaves them; 0 if it does not.
double leaves_at(const Way& way, const HazardObject& object, std::size_t part, double radius) {
  std::vector<Touch> edges;
  for_each_edge(object, part, radius, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double distance) {
    if (const auto touch = touch_of(way, a, b, distance)) edges.push_back(*touch);
  });
  std::ranges::sort(edges, {}, &Touch::first);
  double until = 0.0;
  for (const Touch& edge : edges)
    if (edge.first <= until) until = std::max(until, edge.last);
  return until;
}

Eigen::Vector2d nearest_place(const HazardObject& object, std::size_t part, const Eigen::Vector2d& to) {
  Eigen::Vector2d nearest = to;
  double least = std::numeric_limits<double>::infinity();
  for_each_edge(object, part, 0.0, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double) {
    const Eigen::Vector2d edge = b - a;
    const double length = edge.squaredNorm();
    const Eigen::Vector2d place = a + (length > 0.0 ? std::clamp(edge.dot(to - a) / length, 0.0, 1.0) : 0.0) * edge;
    if ((place - to).norm() < least) least = (place - to).norm(), nearest = place;
  });
  return nearest;
}

}  // namespace

std::optional<Touch> touch_of(const Way& way, const HazardObject& object, double radius) {
  std::optional<Touch> touch;
  for (std::size_t part = 0; part < parts_of(object); ++part)
    touch = hull(touch, touch_of_part(way, object, part, radius));
  return touch;
}

ObjectFinder::ObjectFinder(const Surface& surface, const Barriers& barriers, std::span<const HazardObject> objects,
                           double radius, bool with_rotation)
    : surface_(surface),
      barriers_(barriers),
      objects_(objects),
      with_rotation_(with_rotation),
      near_(surface.grid(), 0) {
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

bool ObjectFinder::only_rim_touches(const PartOfObject& part, const Eigen::Vector2d& place, double radius) const {
  const Way there{place, place};
  return touch_of_part(there, objects_[part.object], part.part, radius) &&
         !touch_of_part(there, objects_[part.object], part.part, 0.0);
}

bool ObjectFinder::stands_behind(const PartOfObject& part, const Eigen::Vector2d& caught) const {
  const Eigen::Vector2d way = nearest_place(objects_[part.object], part.part, caught) - caught;
  const double length = way.norm();  // a little farther: an edge may lie on the line of the barrier
  return length > 0.0 && barriers_.next(caught, caught + (1.0 + kOneLine / length) * way, {}).has_value();
}

/// Calls `visit` for each part of the objects near a span.
template <class Visit>
void ObjectFinder::for_each_part(const Span& span, Visit visit) const {
  for (const std::uint32_t object : objects_near(span))
    for (std::size_t part = 0; part < parts_of(objects_[object]); ++part) visit(PartOfObject{object, part});
}

ObjectFinder::RimLimits ObjectFinder::limits_of(const Path& path, const Block& first, const Block& last) const {
  RimLimits limits;
  if (path.spans.empty()) return limits;
  const auto leaves = [this](const Way& way, const PartOfObject& part, double radius) {
    const double share = leaves_at(way, objects_[part.object], part.part, radius), length = (way.to - way.from).norm();
    return share < 1.0 && length > 0.0 ? std::min(1.0, share + kBeyondEdge / length) : 1.0;
  };
  for_each_part(path.spans.front(), [&](const PartOfObject& part) {
    if (!only_rim_touches(part, way_of(path.spans.front()).from, first.radius())) return;
    PlaceOnPath place;
    for (; place.span < path.spans.size(); ++place.span)
      if ((place.share = leaves(way_of(path.spans[place.span]), part, first.radius())) < 1.0) break;
    limits.begin.emplace_back(part, place);
  });
  if (path.end != End::Caught) return limits;
  const Eigen::Vector2d caught = way_of(path.spans.back()).to;
  for_each_part(path.spans.back(), [&](const PartOfObject& part) {
    if (!only_rim_touches(part, caught, last.radius()) || !stands_behind(part, caught)) return;
    PlaceOnPath place;
    for (std::size_t i = path.spans.size(); i-- > 0;) {
      const Way way = way_of(path.spans[i]);
      place = {i, 1.0 - leaves({way.to, way.from}, part, last.radius())};
      if (place.share > 0.0) break;
    }
    limits.end.emplace_back(part, place);
  });
  return limits;
}

std::optional<Touch> ObjectFinder::touch_in(std::size_t span, const Way& way, const PartOfObject& part, double radius,
                                            const RimLimits& limits) const {
  const HazardObject& object = objects_[part.object];
  if (limits.begin.empty() && limits.end.empty()) return touch_of_part(way, object, part.part, radius);
  const Eigen::Vector2d whole = way.to - way.from;
  std::optional<Touch> all;
  const auto add = [&](double from, double to, double of_rim) {
    if (!(from < to)) return;
    const Way stretch{way.from + from * whole, way.from + to * whole};
    if (const auto touch = touch_of_part(stretch, object, part.part, of_rim))
      all = hull(all, Touch{from + touch->first * (to - from), from + touch->last * (to - from)});
  };
  const auto [from, to] = limits.of_rim(part, span);
  add(0.0, from, 0.0);
  add(from, to, radius);
  add(std::max(from, to), 1.0, 0.0);
  return all;
}

void ObjectFinder::add(const Path& path, const Block& body, std::span<ObjectContact> contacts) const {
  const RimLimits limits = limits_of(path, body, path.breaks.empty() ? body : path.breaks.back().body);
  Block block = body;
  std::vector<PartOfObject> touched;
  auto next_break = path.breaks.begin();
  auto next_spin = path.spins.begin();
  double spin = 0.0;  // [rad/s]
  for (std::size_t i = 0; i < path.spans.size(); ++i) {
    for (; next_break != path.breaks.end() && next_break->span <= i; ++next_break) block = next_break->body;
    for (; next_spin != path.spins.end() && next_spin->span <= i; ++next_spin) spin = next_spin->spin;
    const Span& span = path.spans[i];
    const double rotation = with_rotation_ ? block.rotational_energy_kj(spin) : 0.0;
    const auto energy = [&](double share) {
      return static_cast<float>(0.5e-3 * block.mass * speed_squared_at(span, share) + rotation);
    };
    const Way way = way_of(span);
    for_each_part(span, [&](const PartOfObject& part) {
      const std::optional<Touch> touch = touch_in(i, way, part, block.radius(), limits);
      if (!touch) return;
      ObjectContact& contact = contacts[part.object];
      if (std::ranges::find(touched, part) == touched.end()) {
        touched.push_back(part);
        contact.entry = std::max(contact.entry, energy(touch->first));
      }
      contact.largest = std::max({contact.largest, energy(touch->first), energy(touch->last)});
    });
  }
}

std::pair<double, double> ObjectFinder::RimLimits::of_rim(const PartOfObject& part, std::size_t span) const {
  double from = 0.0, to = 1.0;
  for (const auto& [of, place] : begin)
    if (of == part && span <= place.span) from = span < place.span ? 1.0 : place.share;
  for (const auto& [of, place] : end)
    if (of == part && span >= place.span) to = span > place.span ? 0.0 : place.share;
  return {from, to};
}

}  // namespace talus
