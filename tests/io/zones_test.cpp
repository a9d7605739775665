#include "talus/io/gdal/zones.hpp"

#include <algorithm>

#include "files.hpp"

namespace talus::io::test {

// The map: 10 x 8 cells of 10 m. Counts are by hand.
class Zones : public Files {
 protected:
  Zones() : terrain_(read_terrain(RasterFile{}.write(path("dem.tif")))) {}

  ZoneLayer polygons(const std::vector<std::pair<std::string, OGRFieldType>>& fields, const std::vector<Row>& rows,
                     const std::vector<std::string>& names, const std::string& field = "zone") {
    return read_zones({write_vector(path("z.gpkg"), "EPSG:32632", fields, rows), field, names}, terrain_);
  }
  ZoneLayer raster(const RasterFile& file, const std::vector<std::string>& names) {
    return read_zones({file.write(path("z.tif")), "", names}, terrain_);
  }

  static long count(const ZoneLayer& layer, int zone) {
    return std::count(layer.zones.values.begin(), layer.zones.values.end(), zone);
  }

  Terrain terrain_;
};

const std::vector<std::pair<std::string, OGRFieldType>> kText{{"zone", OFTString}};

TEST_F(Zones, PolygonsByTheCentreOfTheCellWithHolesAndParts) {
  const ZoneLayer layer = polygons(
      kText,
      {{"MULTIPOLYGON(((0 0,50 0,50 50,0 50,0 0),(10 10,40 10,40 40,10 40,10 10)),((60 60,80 60,80 70,60 70,60 60)))",
        {"talus"}}},
      {"road", "talus"});
  EXPECT_EQ(count(layer, 2), 18);
  EXPECT_EQ(count(layer, 0), 62);
  EXPECT_EQ(layer.zones.at(0, 0), 2);
  EXPECT_EQ(layer.zones.at(2, 2), 0);
  EXPECT_EQ(layer.zones.at(6, 6), 2);
  EXPECT_TRUE(said(layer.warnings, "no zone 'road' on the map"));
}

TEST_F(Zones, LaterFeaturesLieOverEarlierOnes) {
  const ZoneLayer layer =
      polygons(kText, {{"POLYGON((0 0,100 0,100 80,0 80,0 0))", {"b"}}, {"POLYGON((0 0,30 0,30 10,0 10,0 0))", {"a"}}},
               {"a", "b"});
  EXPECT_EQ(count(layer, 1), 3);
  EXPECT_EQ(count(layer, 2), 77);
  const ZoneLayer other =
      polygons(kText, {{"POLYGON((0 0,30 0,30 10,0 10,0 0))", {"a"}}, {"POLYGON((0 0,100 0,100 80,0 80,0 0))", {"b"}}},
               {"a", "b"});
  EXPECT_EQ(count(other, 2), 80);
}

TEST_F(Zones, FeaturesWithoutEffectAreNamedAndALayerOffTheMapIsRefused) {
  const Row road{"POLYGON((0 0,30 0,30 10,0 10,0 0))", {"a"}}, off{"POLYGON((900 0,930 0,930 10,900 10,900 0))", {"a"}},
      thin{"POLYGON((0 41,90 41,90 44,0 44,0 41))", {"b"}};  // between the centres of two rows
  const ZoneLayer layer = polygons(kText, {road, off, thin, {"", {"a"}}}, {"a", "b"});
  EXPECT_EQ(count(layer, 1), 3);
  EXPECT_EQ(count(layer, 2), 0);
  EXPECT_TRUE(said(layer.warnings, "wholly off the DEM, which have no effect: FID 2 (a)"));
  EXPECT_TRUE(said(layer.warnings, "no effect: FID 3 (b): draw them wider than a cell, 10 m"));
  EXPECT_TRUE(said(layer.warnings, "without geometry, which have no effect: FID 4 (a)"));
  EXPECT_TRUE(polygons(kText, {road}, {"a"}).warnings.empty());
  EXPECT_TRUE(said(polygons(kText, {}, {}).warnings, "the default ground is everywhere"));
  expect_input_error(
      [&] {
        polygons(kText, {off, off}, {"a"});
      },
      {"z.gpkg: lies wholly off the DEM", "600900", "600930", "600000", "600100"});
}

TEST_F(Zones, WholeNumbersAndNull) {
  const ZoneLayer layer =
      polygons({{"Code", OFTInteger}},
               {{"POLYGON((0 0,30 0,30 10,0 10,0 0))", {"12"}}, {"POLYGON((0 0,10 0,10 10,0 10,0 0))", {"NULL"}}},
               {"12"}, "code");
  EXPECT_EQ(count(layer, 1), 2);  // NULL: the default ground again
  EXPECT_TRUE(said(layer.warnings, "1 of 2 features have no code: the default ground is there"));
  EXPECT_TRUE(said(layer.warnings, "zones that overlap others, in 1 cell: FID 2"));
  const ZoneLayer abutting =
      polygons({{"Code", OFTInteger}},  // along a line of centres
               {{"POLYGON((0 0,30 0,30 15,0 15,0 0))", {"12"}}, {"POLYGON((0 15,30 15,30 30,0 30,0 15))", {"13"}}},
               {"12", "13"}, "code");
  EXPECT_FALSE(said(abutting.warnings, "overlap"));
}

TEST_F(Zones, AZoneThatIsNotDescribedIsNamedWithThoseThatAre) {
  const std::vector<Row> rows{{"POLYGON((0 0,30 0,30 10,0 10,0 0))", {"raod"}}};
  expect_input_error(
      [&] {
        polygons(kText, rows, {"road", "talus"});
      },
      {"z.gpkg: feature 1", "field zone", "zone 'raod'", "road, talus", "[ground.zones.raod]"});
  EXPECT_NO_THROW(polygons(kText,
                           {{"POLYGON((0 0,30 0,30 10,0 10,0 0))", {"road"}},
                            {"POLYGON((900 900,930 900,930 910,900 900))", {"elsewhere"}}},  // off the map
                           {"road"}));
}

TEST_F(Zones, FieldsMustBeThereAndBeCodes) {
  const std::vector<Row> rows{{"POLYGON((0 0,30 0,30 10,0 10,0 0))", {"1"}}};
  expect_input_error(
      [&] {
        polygons({{"zome", OFTString}}, rows, {"1"});
      },
      {"z.gpkg", "no field 'zone'", "did you mean 'zome'?", "[ground]"});
  expect_input_error(
      [&] {
        polygons({{"zone", OFTReal}}, rows, {"1"});
      },
      {"z.gpkg: feature 1", "field zone", "Real", "text or a whole number"});
  expect_input_error(
      [&] {
        polygons(kText, {{"LINESTRING(0 0,30 0)", {"1"}}}, {"1"});
      },
      {"z.gpkg: feature 1", "no polygon"});
}

TEST_F(Zones, PolygonsInAnotherSystem) {  // the whole map, in degrees: 600 000 E 5 200 000 N is 10.3140 E 46.9460 N
                                          // (gdaltransform)
  const std::string file =
      write_vector(path("d.gpkg"), "EPSG:4326", kText,
                   {{"POLYGON((10.31 46.94,10.32 46.94,10.32 46.95,10.31 46.95,10.31 46.94))", {"a"}}});
  const ZoneLayer layer = read_zones({file, "zone", {"a"}}, terrain_);
  EXPECT_EQ(count(layer, 1), 80);
  ASSERT_EQ(layer.reprojections.size(), 1U);
  EXPECT_EQ(layer.reprojections[0].role, "ground");
}

TEST_F(Zones, OneCodeForTwoZonesIsRefusedAndAZoneIsCalledByItsName) {
  const std::string file = RasterFile{.type = GDT_Byte, .values = std::vector<double>(80, 2.0)}.write(path("c.tif"));
  try {
    read_zones({file, "", {"2", "rock face"}, {"", "2"}}, terrain_);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'2' stands for both [ground.zones.2] and [ground.zones.\"rock face\"]"), std::string::npos)
        << text;
  }
  EXPECT_THROW(read_zones({file, "", {"rock face"}, {"2"}, "2"}, terrain_), InputError) << "the default's code";
  const ZoneLayer layer = read_zones({file, "", {"2", "rock face"}, {"", "3"}}, terrain_);
  EXPECT_TRUE(said(layer.warnings, "no zone '3' on the map: [ground.zones.\"rock face\"] is not used"));
}

TEST_F(Zones, RasterOnTheSameGrid) {
  std::vector<double> codes(80, 2.0);
  codes[0] = 7.0;     // the north-western cell
  codes[79] = 255.0;  // the south-eastern one
  const ZoneLayer layer = raster({.type = GDT_Byte, .values = codes, .nodata = 255.0}, {"7", "2"});
  EXPECT_EQ(layer.zones.at(0, 7), 1);
  EXPECT_EQ(layer.zones.at(9, 0), 0);
  EXPECT_EQ(count(layer, 2), 78);
  ASSERT_EQ(layer.warnings.size(), 1U);
  EXPECT_TRUE(said(layer.warnings, "% of the cells of the DEM (off the raster, or nodata)"));
  EXPECT_TRUE(layer.field.empty());
}

TEST_F(Zones,
       RasterOfAnotherGridByTheCentreOfTheCell) {  // 2 x 1 pixels of 45 m from 3 m east and 18 m north of the corner
  const ZoneLayer layer =
      raster({.columns = 2, .rows = 1, .place = {600003, 45, 0, 5200063, 0, -45}, .type = GDT_Int16, .values = {-3, 4}},
             {"4", "-3"});
  // Rows with centres in 18 ... 63: 25, 35, 45, 55. Columns with centres in 3 ... 48: five, and in 48 ... 93: four.
  EXPECT_EQ(count(layer, 2), 5 * 4);
  EXPECT_EQ(count(layer, 1), 4 * 4);
  EXPECT_EQ(layer.zones.at(0, 2), 2);
  EXPECT_EQ(layer.zones.at(8, 5), 1);
  EXPECT_EQ(layer.zones.at(9, 5), 0);
}

TEST_F(Zones, FineRasterBeyondOneTile) {  // pixels of 0.25 m: 400 x 320, code = column of the map
  std::vector<double> codes;
  for (int j = 0; j < 320; ++j)
    for (int i = 0; i < 400; ++i) codes.push_back(i / 40);
  const ZoneLayer layer = raster(
      {.columns = 400, .rows = 320, .place = {600000, 0.25, 0, 5200080, 0, -0.25}, .type = GDT_Byte, .values = codes},
      {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"});
  for (int column = 0; column < 10; ++column)
    for (int row = 0; row < 8; ++row) EXPECT_EQ(layer.zones.at(column, row), column + 1);
}

TEST_F(Zones, RasterInAnotherSystem) {  // in degrees, west of 10.31466 code 1, east of it code 2
  const ZoneLayer layer = raster({.columns = 2,
                                  .rows = 1,
                                  .place = {10.30466, 0.01, 0, 46.955, 0, -0.02},
                                  .system = "EPSG:4326",
                                  .type = GDT_Byte,
                                  .values = {1, 2}},
                                 {"1", "2"});
  // gdaltransform to EPSG:32632: 10.31466 E is 600 047.9 E at the southern edge, 600 046.6 E at the northern one:
  // columns 0 ... 4 have their centres west of it
  for (int row = 0; row < 8; ++row) {
    EXPECT_EQ(layer.zones.at(4, row), 1);
    EXPECT_EQ(layer.zones.at(5, row), 2);
  }
  EXPECT_EQ(count(layer, 1), 40);
}

TEST_F(Zones, RasterCodesMustBeWholeAndDescribed) {
  expect_input_error([&] { raster({.values = std::vector<double>(80, 2.5)}, {"2"}); },
                     {"z.tif", "holds 2.5", "whole numbers"});
  expect_input_error(
      [&] {
        raster({.type = GDT_Byte, .values = std::vector<double>(80, 3.0)}, {"2", "4"});
      },
      {"z.tif", "zone '3'", "2, 4", "[ground.zones.3]"});
  EXPECT_NO_THROW(raster({.type = GDT_UInt32, .values = std::vector<double>(80, 100000.0)}, {"100000"}));
}

TEST_F(Zones, ARasterThatCoversLittleIsSaidAndOneThatCoversNothingIsRefused) {
  const RasterFile all{.type = GDT_Byte, .values = std::vector<double>(80, 2.0), .nodata = 0.0};
  EXPECT_TRUE(raster(all, {"2"}).warnings.empty());
  RasterFile half = all;
  std::fill_n(half.values.begin(), 40, 0.0);
  EXPECT_TRUE(said(raster(half, {"2"}).warnings, "gives no zone to 50 % of the cells of the DEM"));
  RasterFile off = all, empty = all;
  off.place[0] = 700000.0;
  expect_input_error([&] { raster(off, {"2"}); },
                     {"z.tif: gives no cell of the DEM a zone", "700000", "700100", "600000", "600100"});
  std::ranges::fill(empty.values, 0.0);
  expect_input_error([&] { raster(empty, {"2"}); }, {"gives no cell of the DEM a zone", "nodata there?"});
}

TEST_F(Zones, AFieldIsForPolygonsOnly) {
  const std::string file = RasterFile{.type = GDT_Byte, .values = std::vector<double>(80, 3.0)}.write(path("z.tif"));
  expect_input_error([&] { read_zones({file, "zone", {"3"}}, terrain_); }, {"z.tif", "is a raster", "field = 'zone'"});
}

}  // namespace talus::io::test
