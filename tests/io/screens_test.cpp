#include "files.hpp"
#include "talus/io/gdal/lines.hpp"

namespace talus::io::test {

class Screens : public Files {
 protected:
  Screens() : terrain_(read_terrain(RasterFile{}.write(path("dem.tif")))) {}
  ScreenLayer read(const std::vector<std::pair<std::string, OGRFieldType>>& fields, const std::vector<Row>& rows) {
    return read_screens(write_vector(path("s.gpkg"), "EPSG:32632", fields, rows), terrain_);
  }
  Terrain terrain_;
};

TEST_F(Screens, LinesWithTheirIds) {
  const ScreenLayer layer = read({{"ID", OFTString}}, {{"LINESTRING(10 20,30 40,50 40)", {"road"}},
                                                       {"MULTILINESTRING((11 11,12 12),(13 13,14 15))", {"net"}}});
  ASSERT_EQ(layer.screens.size(), 2U);
  EXPECT_EQ(layer.screens[0].id, "road");
  ASSERT_EQ(layer.screens[0].lines.size(), 1U);
  ASSERT_EQ(layer.screens[0].lines[0].size(), 3U);
  EXPECT_NEAR(layer.screens[0].lines[0][1].x(), 30.0, 1e-9);
  EXPECT_NEAR(layer.screens[0].lines[0][1].y(), 40.0, 1e-9);
  EXPECT_EQ(layer.screens[1].lines.size(), 2U);
  EXPECT_TRUE(layer.warnings.empty());
}

TEST_F(Screens, WithoutIdTheNumberOfTheFeature) {
  EXPECT_EQ(read({}, {{"LINESTRING(1 1,2 2)"}}).screens[0].id, "1");
  EXPECT_EQ(
      read({{"id", OFTInteger}}, {{"LINESTRING(1 1,2 2)", {"7"}}, {"LINESTRING(1 1,2 2)", {"NULL"}}}).screens[1].id,
      "2");
}

TEST_F(Screens, ANumberThatIsTheIdOfAnotherIsRefused) {
  for (const auto& rows : {std::vector<Row>{{"LINESTRING(11 11,12 12)", {"NULL"}}, {"LINESTRING(11 11,12 12)", {"1"}}},
                           std::vector<Row>{{"LINESTRING(11 11,12 12)", {"2"}}, {"LINESTRING(11 11,12 12)", {"NULL"}}}})
    expect_input_error(
        [&] {
          read({{"id", OFTString}}, rows);
        },
        {"s.gpkg: feature " + std::string(rows[0].values[0] == "NULL" ? "1" : "2") + ": has no id",
         "is the id of another line, must have an id of its own"});
}

TEST_F(Screens, FeaturesOfTheSameIdAreOneScreen) {
  const ScreenLayer layer =
      read({{"id", OFTInteger}},
           {{"LINESTRING(1 1,2 2)", {"7"}}, {"LINESTRING(1 1,2 2)", {"8"}}, {"LINESTRING(3 3,2 2)", {"7"}}});
  ASSERT_EQ(layer.screens.size(), 2U);
  EXPECT_EQ(layer.screens[0].lines.size(), 2U);
}

TEST_F(Screens,
       LinesOfOneScreenOnEachOtherAreWarnedOf) {  // 5 m from (4, 1) to (9, 1); a line that only crosses is fine
  const ScreenLayer layer =
      read({{"id", OFTString}},
           {{"LINESTRING(1 1,9 1)", {"road"}}, {"LINESTRING(12 1,4 1)", {"road"}}, {"LINESTRING(5 0,5 3)", {"road"}}});
  EXPECT_TRUE(
      said(layer.warnings, "lines of screen road lie on each other for 5 m: crossings there count more than once"));
  EXPECT_TRUE(
      said(read({{"id", OFTString}}, {{"LINESTRING(1 1,1 7,5 7,1 7,1 3)", {"a"}}}).warnings, "for 8 m"));  // back
  EXPECT_TRUE(said(  // one from south to north, where pieces far apart begin at the same x
      read({{"id", OFTString}}, {{"LINESTRING(1 1,1 3,1 9)", {"a"}}, {"LINESTRING(1 14,1 4)", {"a"}}}).warnings,
      "for 5 m"));
  EXPECT_FALSE(
      said(read({{"id", OFTString}}, {{"LINESTRING(1 1,9 1)", {"a"}}, {"LINESTRING(1 1,9 1)", {"b"}}}).warnings,
           "lie on each other"));
}

TEST_F(Screens, ACsvIsInTheSystemOfTheDem) {
  const std::string file =
      write_text("s.csv", "id,wkt\nS1,\"LINESTRING (600006.00 5200010.00, 600094.00 5200012.50)\"\n");
  const ScreenLayer layer = read_screens(file, terrain_);
  ASSERT_EQ(layer.screens.size(), 1U);
  EXPECT_EQ(layer.screens[0].id, "S1");
  EXPECT_NEAR(layer.screens[0].lines[0][1].x(), 94.0, 1e-9);
  EXPECT_NEAR(layer.screens[0].lines[0][1].y(), 12.5, 1e-9);
  EXPECT_TRUE(layer.warnings.empty());
}

TEST_F(Screens, OtherGeometriesAreRefused) {
  expect_input_error([&] { read({}, {{"POLYGON((0 0,1 0,1 1,0 0))"}}); }, {"s.gpkg: feature 1", "is no line"});
  expect_input_error([&] { read({}, {{""}}); }, {"s.gpkg: feature 1", "has no geometry"});
  expect_input_error([&] { read({}, {{"LINESTRING(1 1,1 1)"}}); }, {"s.gpkg: feature 1", "no length"});
  expect_input_error([&] { read({}, {}); }, {"s.gpkg", "no features"});
  expect_input_error(
      [&] {
        read({{"id", OFTReal}}, {{"LINESTRING(1 1,2 2)", {"7.5"}}});
      },
      {"s.gpkg: feature 1", "field id = 7.5", "text or a whole number"});
}

TEST_F(Screens, OffTheMapIsWarnedOf) {
  const std::vector<std::string> warnings = read({}, {{"LINESTRING(500 1,500 2)"}}).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(said(warnings, "which nothing will cross: features 1"));
}

TEST_F(Screens, WhereTheDemHasNoHeightIsWarnedOf) {
  const auto warnings =
      read({{"id", OFTString}}, {{"LINESTRING(50 40,140 40)", {"half"}},      // the last height at 95
                                 {"LINESTRING(10 2,80 2)", {"at the edge"}},  // in the outer half cell
                                 {"LINESTRING(10 40,80 40)", {"well"}}})
          .warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(said(warnings,
                   "s.gpkg: where the DEM has no height (off it, in its outer half cell or in a gap) lie 50 % of "
                   "screen half, 100 % of screen at the edge: blocks do not get there"));
}

}  // namespace talus::io::test
