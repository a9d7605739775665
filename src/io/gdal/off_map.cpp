#include "off_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace talus::io {
namespace {

using Point = Eigen::Vector2d;

/// The part of a closed ring on one side of a line along an axis: where coordinate `axis` is at least `bound`, or at
/// most where `below`. Parts that are apart stay joined by edges that enclose nothing (Sutherland and Hodgman, 1974).
std::vector<Point> cut(const std::vector<Point>& ring, int axis, double bound, bool below) {
  const auto inside = [&](const Point& p) { return below ? p[axis] <= bound : p[axis] >= bound; };
  std::vector<Point> out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if (inside(a)) out.push_back(a);
    if (inside(a) == inside(b)) continue;
    Point crossing = a + (bound - a[axis]) / (b[axis] - a[axis]) * (b - a);
    crossing[axis] = bound;
    out.push_back(crossing);
  }
  return out;
}

double area_of(const std::vector<Point>& ring) {
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Point a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2.0;
}

/// Whole area or length or number, and how much of it lies on the grid.
struct Amount {
  double whole = 0.0, inside = 0.0;
};

void add(const OGRLinearRing& ring, const Grid& grid, double sign, Amount& area) {
  std::vector<Point> points;
  for (int i = 0; i < ring.getNumPoints(); ++i) points.emplace_back(ring.getX(i), ring.getY(i));
  area.whole += sign * area_of(points);
  for (int axis = 0; axis < 2; ++axis) {
    points = cut(points, axis, 0.0, false);
    points = cut(points, axis, axis == 0 ? grid.width() : grid.height(), true);
  }
  area.inside += sign * area_of(points);
}

/// Share of the segment from `a` to `b` that lies on the grid (Liang and Barsky, 1984).
double share_inside(const Point& a, const Point& b, const Grid& grid) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double size = axis == 0 ? grid.width() : grid.height(), step = b[axis] - a[axis];
    if (step == 0.0) {
      if (a[axis] < 0.0 || a[axis] > size) return 0.0;
      continue;
    }
    const double one = -a[axis] / step, other = (size - a[axis]) / step;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
  }
  return std::max(0.0, to - from);
}

void add(const OGRLineString& line, const Grid& grid, Amount& length) {
  for (int i = 0; i + 1 < line.getNumPoints(); ++i) {
    const Point a(line.getX(i), line.getY(i)), b(line.getX(i + 1), line.getY(i + 1));
    length.whole += (b - a).norm();
    length.inside += (b - a).norm() * share_inside(a, b, grid);
  }
}

}  // namespace

double share_outside(const Parts& parts, const Grid& grid) {
  Amount amount;
  for (const OGRPolygon& polygon : parts.polygons) {
    double sign = 1.0;  // the outer ring is the first, the others are holes
    for (const OGRLinearRing* ring : polygon) {
      add(*ring, grid, sign, amount);
      sign = -1.0;
    }
  }
  if (parts.polygons.empty())
    for (const OGRLineString& line : parts.lines) add(line, grid, amount);
  if (parts.polygons.empty() && parts.lines.empty())
    for (const Point& point : parts.points) {
      amount.whole += 1.0;
      amount.inside += grid.contains(grid.column_of(point.x()), grid.row_of(point.y())) ? 1.0 : 0.0;
    }
  return amount.whole > 0.0 ? std::clamp(1.0 - amount.inside / amount.whole, 0.0, 1.0) : 0.0;
}

bool wholly_off(const OGREnvelope& box, const Grid& grid) {
  return box.MaxX < 0.0 || box.MinX > grid.width() || box.MaxY < 0.0 || box.MinY > grid.height();
}

std::string brought_from(const Layer& layer) {
  return layer.reprojections().empty() ? "" : crs_name(layer.crs_wkt());
}

std::string extents_text(const OGREnvelope& box, const std::string& from, const Terrain& terrain) {
  const Grid& grid = terrain.heights.grid;
  return extent_text({box.MinX + grid.west, box.MinY + grid.south, box.MaxX + grid.west, box.MaxY + grid.south}) +
         (from.empty() ? "" : " (brought from " + from + ")") + ", the DEM over " + extent_text(terrain.extent()) +
         " in " + crs_name(terrain.geo.crs_wkt);
}

/// Likely cause of a layer off the map: degrees taken for metres, x and y exchanged, or another coordinate system.
std::string mistaken_text(const OGREnvelope& box, const Grid& grid) {
  const double west = box.MinX + grid.west, south = box.MinY + grid.south;
  const double east = box.MaxX + grid.west, north = box.MaxY + grid.south;
  if (west >= -180.0 && east <= 180.0 && south >= -180.0 && north <= 180.0)
    return "these look like degrees, taken for metres: give the layer its coordinate system";
  OGREnvelope exchanged;
  exchanged.MinX = south - grid.west, exchanged.MaxX = north - grid.west;
  exchanged.MinY = west - grid.south, exchanged.MaxY = east - grid.south;
  return wholly_off(exchanged, grid) ? "is the coordinate system of the layer the right one?"
                                     : "x and y look exchanged";
}

std::string off_dem_text(const std::string& path, const OGREnvelope& box, const Layer& layer, const Terrain& terrain) {
  return path + ": lies wholly off the DEM: its features reach over " +
         extents_text(box, brought_from(layer), terrain) + ": " + mistaken_text(box, terrain.heights.grid);
}

const char* kind_of(const Parts& parts) {
  const bool polygons = !parts.polygons.empty(), lines = !parts.lines.empty(), points = !parts.points.empty();
  if (polygons && !lines && !points) return "polygon";
  if (lines && !polygons && !points) return "line";
  return points && !polygons && !lines ? "point" : "feature";
}

}  // namespace talus::io
