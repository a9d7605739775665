#include "object_finder.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace talus {

namespace bg = boost::geometry;

double ObjectFinder::Shape::distance(const Segment& segment) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Polygon& polygon : polygons) least = std::min(least, bg::distance(segment, polygon));
  for (const Line& line : lines) least = std::min(least, bg::distance(segment, line));
  return least;
}

ObjectFinder::ObjectFinder(const Surface& surface, std::span<const HazardObject> objects, double radius)
    : surface_(surface), near_(surface.grid(), 0) {
  const auto append = [](auto& to, const HazardObject::Ring& ring) {
    for (const Eigen::Vector2d& p : ring) bg::append(to, Point(p.x(), p.y()));
  };
  for (const HazardObject& object : objects) {
    Shape& shape = shapes_.emplace_back();
    for (const auto& rings : object.polygons) {
      Polygon& polygon = shape.polygons.emplace_back();
      polygon.inners().resize(rings.size() - 1);
      append(polygon.outer(), rings[0]);
      for (std::size_t i = 1; i < rings.size(); ++i) append(polygon.inners()[i - 1], rings[i]);
      bg::correct(polygon);
    }
    for (const HazardObject::Ring& line : object.lines) append(shape.lines.emplace_back(), line);
    enter(object, radius);
  }
}

/// Adds an object to the list of each patch from which a block of this radius may touch it.
void ObjectFinder::enter(const HazardObject& object, double radius) {
  const auto number = static_cast<std::uint32_t>(shapes_.size() - 1);
  Eigen::AlignedBox2d box;
  for (const auto& rings : object.polygons)
    for (const Eigen::Vector2d& p : rings[0]) box.extend(p);
  for (const HazardObject::Ring& line : object.lines)
    for (const Eigen::Vector2d& p : line) box.extend(p);
  const Grid& grid = surface_.grid();
  const auto clamped = [](double value, int last) { return static_cast<int>(std::clamp(value, 0.0, double(last))); };
  const int west = clamped(surface_.u_of(box.min().x() - radius), grid.columns - 1),
            east = clamped(surface_.u_of(box.max().x() + radius), grid.columns - 1),
            south = clamped(surface_.v_of(box.min().y() - radius), grid.rows - 1),
            north = clamped(surface_.v_of(box.max().y() + radius), grid.rows - 1);
  const double reach = radius + 0.5 * std::hypot(grid.cell_x, grid.cell_y);  // from the centre of a patch
  for (int row = south; row <= north; ++row)
    for (int column = west; column <= east; ++column) {
      const Point middle(surface_.x_of(column + 0.5), surface_.y_of(row + 0.5));
      if (shapes_[number].distance({middle, middle}) > reach) continue;
      std::int32_t& list = near_.at(column, row);
      if (list == 0) {
        lists_.emplace_back();
        list = static_cast<std::int32_t>(lists_.size());
      }
      lists_[static_cast<std::size_t>(list) - 1].push_back(number);
    }
}

void ObjectFinder::raise(std::span<const Span> spans, const Block& body, std::span<float> energies) const {
  for (const Span& span : spans) {
    if (!near_.grid.contains(span.patch.column, span.patch.row)) continue;
    const std::int32_t list = near_.at(span.patch.column, span.patch.row);
    if (list == 0) continue;
    const float rise_squared = std::max(span.rise_from * span.rise_from, span.rise_to * span.rise_to);
    const auto energy = static_cast<float>(0.5e-3 * body.mass * (span.plan_speed_squared + rise_squared));
    const auto place = [&](float p, float q) {
      return Point(surface_.x_of(span.patch.column + double{p}), surface_.y_of(span.patch.row + double{q}));
    };
    const Segment way(place(span.p_from, span.q_from), place(span.p_to, span.q_to));
    for (const std::uint32_t object : lists_[static_cast<std::size_t>(list) - 1])
      if (energy > energies[object] && shapes_[object].distance(way) <= body.radius()) energies[object] = energy;
  }
}

void ObjectFinder::raise(const Path& path, const Block& body, std::span<float> energies) const {
  const std::span<const Span> spans(path.spans);
  std::size_t from = 0;
  Block block = body;
  for (const Broken& broken : path.breaks) {
    raise(spans.subspan(from, broken.span - from), block, energies);
    from = broken.span;
    block = broken.body;
  }
  raise(spans.subspan(from), block, energies);
}

}  // namespace talus
