#include "io/gdal/off_map.hpp"

#include "files.hpp"

namespace talus::io::test {

namespace {

const Grid kGrid{10, 5, 10.0, 10.0, 0.0, 0.0};  // 100 x 50 m

Parts parts_of(const char* wkt) {
  OGRGeometry* made = nullptr;
  EXPECT_EQ(OGRGeometryFactory::createFromWkt(wkt, nullptr, &made), OGRERR_NONE);
  const std::unique_ptr<OGRGeometry> geometry(made);
  Parts parts;
  const auto type = wkbFlatten(geometry->getGeometryType());
  if (type == wkbPolygon) parts.polygons.push_back(*geometry->toPolygon());
  if (type == wkbLineString) parts.lines.push_back(*geometry->toLineString());
  return parts;
}

double outside(const char* wkt) {
  return share_outside(parts_of(wkt), kGrid);
}

}  // namespace

TEST(ShareOutside, OfPolygonsIsThatOfTheirArea) {
  EXPECT_EQ(outside("POLYGON((10 10,20 10,20 20,10 20,10 10))"), 0.0);
  EXPECT_DOUBLE_EQ(outside("POLYGON((10 10,20 10,20 90,10 90,10 10))"), 0.5);
  EXPECT_DOUBLE_EQ(outside("POLYGON((-100 -50,100 -50,100 50,-100 50,-100 -50))"), 0.75);  // a corner
  EXPECT_DOUBLE_EQ(outside("POLYGON((-10 0,0 10,-10 20,-20 10,-10 0))"), 1.0);
  // A triangle with half its base on the map: a quarter of its height lies above y = 50, so 1/16 of its area.
  EXPECT_NEAR(outside("POLYGON((20 0,60 0,40 66.666666666666667,20 0))"), 1.0 / 16.0, 1e-12);
  // A ring of 40 x 40 less 20 x 20, of which the right half is outside; the way round changes nothing.
  EXPECT_DOUBLE_EQ(outside("POLYGON((80 5,120 5,120 45,80 45,80 5),(90 15,90 35,110 35,110 15,90 15))"), 0.5);
  EXPECT_DOUBLE_EQ(outside("POLYGON((80 5,80 45,120 45,120 5,80 5),(90 15,110 15,110 35,90 35,90 15))"), 0.5);
  // A hole of 10 x 20 on the map alone.
  EXPECT_DOUBLE_EQ(outside("POLYGON((80 5,120 5,120 45,80 45,80 5),(82 15,82 35,92 35,92 15,82 15))"), 800.0 / 1400.0);
}

TEST(ShareOutside, OfAConcavePolygonWithTwoPartsInside) {
  // A U that hangs in from the north: two legs of 10 x 30 m, 20 m of each on the map, and a bar of 30 x 10.
  EXPECT_DOUBLE_EQ(outside("POLYGON((10 30,20 30,20 60,30 60,30 30,40 30,40 70,10 70,10 30))"), 500.0 / 900.0);
}

TEST(ShareOutside, OfLinesIsThatOfTheirLength) {
  EXPECT_DOUBLE_EQ(outside("LINESTRING(50 25,150 25)"), 0.5);
  EXPECT_DOUBLE_EQ(outside("LINESTRING(-50 25,150 25)"), 0.5);
  EXPECT_DOUBLE_EQ(outside("LINESTRING(-10 0,-10 50)"), 1.0);
  EXPECT_DOUBLE_EQ(outside("LINESTRING(10 10,20 10,20 20)"), 0.0);
  EXPECT_DOUBLE_EQ(outside("LINESTRING(0 60,20 40)"), 0.5);
}

TEST(ShareOutside, OfPointsIsThatOfTheirNumber) {
  Parts parts;
  parts.points = {{5.0, 5.0}, {-5.0, 5.0}, {50.0, 80.0}, {99.0, 49.0}};
  EXPECT_DOUBLE_EQ(share_outside(parts, kGrid), 0.5);
}

}  // namespace talus::io::test
