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

/// Finds which objects a path comes to. Patches that are near an object know it: most of a path asks nothing more.
class ObjectFinder {
 public:
  /// @param radius  of the largest block [m]
  ObjectFinder(const Surface& surface, std::span<const HazardObject> objects, double radius);

  /// Raises the energy of each object that the path comes to [kJ]; below 0 stands for none so far.
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
  Raster<std::int32_t> near_;  // by patch: 0, or one more than the list of objects that are near
  std::vector<std::vector<std::uint32_t>> lists_;
};

}  // namespace talus
