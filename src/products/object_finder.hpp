#pragma once
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <vector>

#include "talus/physics/path.hpp"
#include "talus/products/objects.hpp"

namespace talus {

/// Finds which objects a path hits. Each patch has a list of the objects near it, so most patches need no further test.
class ObjectFinder {
 public:
  /// @param radius  of the largest block [m]
  ObjectFinder(const Surface& surface, std::span<const HazardObject> objects, double radius);

  /// Raises the energy of each object that the path hits [kJ]; a negative energy means no hit so far.
  void raise(const Path& path, const Block& body, std::span<float> energies) const;

 private:
  using Point = boost::geometry::model::d2::point_xy<double>;
  using Segment = boost::geometry::model::segment<Point>;
  using Polygon = boost::geometry::model::polygon<Point>;
  using Line = boost::geometry::model::linestring<Point>;
  struct Shape {
    std::vector<Polygon> polygons;
    std::vector<Line> lines;
    double distance(const Segment& segment) const;
  };

  void enter(const HazardObject& object, double radius);
  void raise(std::span<const Span> spans, const Block& body, std::span<float> energies) const;

  const Surface& surface_;
  std::vector<Shape> shapes_;
  Raster<std::int32_t> near_;  // by patch: 0, or 1 + the index of its list
  std::vector<std::vector<std::uint32_t>> lists_;
};

}  // namespace talus
