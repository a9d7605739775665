#include <algorithm>
#include <cmath>

#include "files.hpp"
#include "talus/io/gdal/lines.hpp"

namespace talus::io::test {

class BarrierFile : public Files {
 protected:
  BarrierFile() : terrain_(read_terrain(RasterFile{}.write(path("dem.tif")))) {}
  BarrierLayer read(const std::vector<std::pair<std::string, OGRFieldType>>& fields, const std::vector<Row>& rows) {
    return read_barriers(write_vector(path("n.gpkg"), "EPSG:32632", fields, rows), terrain_);
  }
  const std::vector<std::pair<std::string, OGRFieldType>> fields_{
      {"id", OFTString}, {"Height", OFTReal}, {"capacity", OFTReal}};
  Terrain terrain_;
};

TEST_F(BarrierFile, EachFeatureWithItsNumbers) {
  const BarrierLayer layer = read(fields_, {{"LINESTRING(10 20,30 40)", {"road", "4.5", "1000"}},
                                            {"MULTILINESTRING((11 11,12 12),(13 13,14 15))", {"road", "2", "inf"}}});
  ASSERT_EQ(layer.barriers.size(), 2U);
  EXPECT_EQ(layer.barriers[0].id, "road");
  EXPECT_EQ(layer.barriers[0].height, 4.5);
  EXPECT_EQ(layer.barriers[0].capacity, 1e6);
  EXPECT_NEAR(layer.barriers[0].lines[0][1].x(), 30.0, 1e-9);
  EXPECT_EQ(layer.barriers[1].lines.size(), 2U);
  EXPECT_TRUE(std::isinf(layer.barriers[1].capacity));
  EXPECT_TRUE(layer.warnings.empty());
}

/// A net drawn there and back would take its capacity twice; two nets on one line are intended.
TEST_F(BarrierFile, OneOnItselfIsSaid) {
  EXPECT_TRUE(said(read(fields_, {{"LINESTRING(1 1,1 7,5 7,1 7,1 3)", {"a", "4", "100"}}}).warnings,
                   "lines of barrier a lie on each other for 8 m: it takes its capacity from a block there more than"));
  const BarrierLayer two =
      read(fields_, {{"LINESTRING(1 1,9 1)", {"a", "4", "100"}}, {"LINESTRING(1 1,9 1)", {"b", "4", "9"}}});
  EXPECT_FALSE(said(two.warnings, "lie on each other"));
}

TEST_F(BarrierFile, PartlyWhereTheTerrainEndsIsSaid) {
  const BarrierLayer layer = read(fields_, {{"LINESTRING(-40 20,40 20)", {"road", "4", "1000"}}});
  EXPECT_TRUE(said(layer.warnings, " of barrier road: blocks do not get there, so that nothing is caught there"));
}

TEST_F(BarrierFile, WithoutIdsTheyHaveTheirNames) {
  const BarrierLayer layer = read({{"name", OFTString}, {"height", OFTReal}, {"capacity", OFTReal}},
                                  {{"LINESTRING(10 20,30 40)", {"road A", "4.5", "1000"}}});
  EXPECT_EQ(layer.barriers[0].id, "road A");
  EXPECT_EQ(std::ranges::count_if(layer.notes, [](const std::string& n) { return n.find("no field id") != n.npos; }),
            0);
}

TEST_F(BarrierFile, WrongOnesAreRefused) {
  const auto refused = [&](const Row& row, const std::vector<std::string>& words) {
    expect_input_error([&] { read(fields_, {row}); }, words);
  };
  refused({"LINESTRING(1 1,2 2)", {"a", "-1", "100"}}, {"n.gpkg: feature 1", "height = -1", "0 to 100 m"});
  refused({"LINESTRING(1 1,2 2)", {"a", "4", "-1"}}, {"n.gpkg: feature 1", "capacity = -1", "kJ"});
  refused({"LINESTRING(1 1,2 2)", {"a", "NULL", "1"}}, {"n.gpkg: feature 1", "has no height"});
  refused({"LINESTRING(1 1,2 2)", {"a", "4", "NULL"}}, {"n.gpkg: feature 1", "has no capacity"});
  refused({"POLYGON((0 0,1 0,1 1,0 0))", {"a", "4", "1"}}, {"is no line", "height (m) and capacity (kJ; inf"});
  expect_input_error(
      [&] {
        read(fields_, {{"LINESTRING(1 1,2 2)", {"2", "4", "1"}}, {"LINESTRING(1 1,2 2)", {"NULL", "4", "1"}}});
      },
      {"n.gpkg: feature 2: has no id", "its number 2 is the id of another line"});
  expect_input_error([&] { read(fields_, {}); }, {"n.gpkg", "no features"});
  expect_input_error(
      [&] {
        read({{"id", OFTString}}, {{"LINESTRING(1 1,2 2)", {"a"}}});
      },
      {"has no height", "capacity (kJ; inf: any energy, as a dam)"});
}

}  // namespace talus::io::test
