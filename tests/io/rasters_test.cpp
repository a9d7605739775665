#include "talus/io/gdal/rasters.hpp"

#include <gdal_utils.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "files.hpp"

namespace talus::io::test {

using Terrains = Files;

TEST_F(Terrains, RowZeroIsTheSouthernOne) {
  const Terrain t = read_terrain(RasterFile{}.write(path("dem.tif")));
  EXPECT_EQ(t.heights.grid, (Grid{10, 8, 10.0, 10.0, 600000.0, 5200000.0}));
  EXPECT_FLOAT_EQ(t.heights.at(0, 0), 1070.0F);  // row 7 of the file
  EXPECT_FLOAT_EQ(t.heights.at(9, 7), 1009.0F);
  EXPECT_FLOAT_EQ(t.heights.at(3, 5), 1023.0F);
  EXPECT_DOUBLE_EQ(t.geo.north, 5200080.0);
  EXPECT_DOUBLE_EQ(t.geo.west, 600000.0);
  EXPECT_TRUE(t.warnings.empty());
}

TEST_F(Terrains, CellsNeedNotBeSquare) {
  const Terrain t = read_terrain(RasterFile{.place = {0.0 + 5e5, 5.0, 0, 5e6, 0, -2.5}}.write(path("dem.tif")));
  EXPECT_DOUBLE_EQ(t.heights.grid.cell_x, 5.0);
  EXPECT_DOUBLE_EQ(t.heights.grid.cell_y, 2.5);
  EXPECT_DOUBLE_EQ(t.heights.grid.south, 5e6 - 20.0);
  EXPECT_DOUBLE_EQ(t.geo.cell_y, 2.5);
}

TEST_F(Terrains, MissingValuesOfEveryKindAreNan) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Terrain t = read_terrain(
      RasterFile{.columns = 3, .rows = 2, .values = {1, -9999, nan, inf, -inf, 6}, .nodata = -9999.0}.write(
          path("dem.tif")));
  EXPECT_FLOAT_EQ(t.heights.at(0, 1), 1.0F);
  EXPECT_FLOAT_EQ(t.heights.at(2, 0), 6.0F);
  for (const auto& [column, row] : {std::pair{1, 1}, {2, 1}, {0, 0}, {1, 0}})
    EXPECT_TRUE(std::isnan(t.heights.at(column, row)));
}

TEST_F(Terrains, ScaleAndOffsetOfWholeNumbersAreApplied) {  // -32768 is the missing value as it is stored
  const Terrain t = read_terrain(RasterFile{.columns = 2,
                                            .rows = 2,
                                            .type = GDT_Int16,
                                            .values = {100, 200, -32768, 12345},
                                            .nodata = -32768.0,
                                            .scale = 0.1,
                                            .offset = 500}
                                     .write(path("dem.tif")));
  EXPECT_FLOAT_EQ(t.heights.at(0, 1), 510.0F);
  EXPECT_FLOAT_EQ(t.heights.at(1, 1), 520.0F);
  EXPECT_FLOAT_EQ(t.heights.at(1, 0), 1734.5F);
  EXPECT_TRUE(std::isnan(t.heights.at(0, 0)));
}

TEST_F(Terrains, EveryNumberTypeIsRead) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_UInt32, GDT_Int32, GDT_Float32, GDT_Float64}) {
    const Terrain t =
        read_terrain(RasterFile{.columns = 2, .rows = 2, .type = type, .values = {1, 2, 3, 4}}.write(path("dem.tif")));
    EXPECT_FLOAT_EQ(t.heights.at(0, 0), 3.0F) << GDALGetDataTypeName(type);
  }
}

TEST_F(Terrains, UndeclaredMissingValuesAreRefusedWithTheirCell) {
  std::vector<double> values(80, 700.0);
  values[2 * 10 + 7] = -9999.0;
  const std::string dem = RasterFile{.values = values}.write(path("dem.tif"));
  expect_input_error([&] { read_terrain(dem); },
                     {"dem.tif", "-9999 m", "column 7, row 2", "-500 to 9000 m", "gdal_edit.py -a_nodata -9999"});
}

TEST_F(Terrains, ZerosAmongMountainsAreSuspect) {
  std::vector<double> values(80, 700.0);
  values[0] = 0.0;
  EXPECT_TRUE(
      said(read_terrain(RasterFile{.values = values}.write(path("dem.tif"))).warnings, "1 cell has the height 0"));
  EXPECT_TRUE(read_terrain(RasterFile{.values = values, .nodata = 0.0}.write(path("b.tif"))).warnings.empty());
  for (std::size_t i = 1; i < values.size(); ++i) values[i] -= 900.0;  // a pit below the sea
  EXPECT_TRUE(said(read_terrain(RasterFile{.values = values}.write(path("c.tif"))).warnings,
                   "1 cell has the height 0 and all others less than -200 m"));
}

TEST_F(Terrains, HeightsFarFromAllOthersAreSuspect) {
  std::vector<double> values(80, 700.0);
  values[5] = 500.5;  // a step of 199.5 m may be a cliff
  EXPECT_TRUE(read_terrain(RasterFile{.values = values}.write(path("cliff.tif"))).warnings.empty());
  values[5] = values[6] = -99.0;
  EXPECT_TRUE(said(read_terrain(RasterFile{.values = values}.write(path("low.tif"))).warnings,
                   "2 cells have the height -99 m, and all others are at 700 m or higher"));
  values[5] = 0.0, values[6] = -0.0001;
  EXPECT_TRUE(said(read_terrain(RasterFile{.values = values}.write(path("two.tif"))).warnings,
                   "2 cells have heights of -0.0001 to 0 m, and all others are at 700 m or higher"));
  values[5] = values[6] = 700.0, values[79] = 8888.0;
  EXPECT_TRUE(said(read_terrain(RasterFile{.values = values}.write(path("high.tif"))).warnings,
                   "1 cell has the height 8888 m, and all others are at 700 m or lower"));
}

TEST_F(Terrains, OnlyMissingValuesAreRefused) {
  const std::string dem = RasterFile{.values = std::vector<double>(80, -1.0), .nodata = -1.0}.write(path("dem.tif"));
  expect_input_error([&] { read_terrain(dem); }, {"dem.tif", "all cells are missing"});
}

TEST_F(Terrains, MustBeNorthUp) {
  const double c = 10.0 * std::cos(0.1), s = 10.0 * std::sin(0.1);
  const std::string rotated = RasterFile{.place = {6e5, c, s, 5.2e6, s, -c}}.write(path("rotated.tif"));
  expect_input_error([&] { read_terrain(rotated); }, {"rotated.tif", "rotated", "5.73 deg", "gdalwarp -r cubicspline"});
  const std::string upside = RasterFile{.place = {6e5, 10, 0, 5.2e6, 0, 10}}.write(path("upside.tif"));
  expect_input_error([&] { read_terrain(upside); }, {"upside.tif", "south to north", "gdalwarp"});
  const std::string nowhere = RasterFile{.placed = false}.write(path("nowhere.tif"));
  expect_input_error([&] { read_terrain(nowhere); }, {"nowhere.tif", "geotransform", "gdal_edit.py -a_ullr"});
}

TEST_F(Terrains, MustBeInMetres) {
  const std::string degrees =
      RasterFile{.place = {11.0, 1e-4, 0, 47.0, 0, -1e-4}, .system = "EPSG:4326"}.write(path("degrees.tif"));
  expect_input_error([&] { read_terrain(degrees); },
                     {"degrees.tif", "in degrees", "EPSG:4326",
                      "gdalwarp -t_srs EPSG:32632 -r cubicspline"});                   // 11 E is in UTM zone 32
  const std::string feet = RasterFile{.system = "EPSG:2230"}.write(path("feet.tif"));  // California VI, US survey foot
  expect_input_error([&] { read_terrain(feet); },
                     {"feet.tif", "US survey foot", "must be metres", "gdalwarp -t_srs EPSG:"});
  const std::string none = RasterFile{.system = ""}.write(path("none.tif"));
  expect_input_error([&] { read_terrain(none); }, {"none.tif", "no coordinate system", "gdal_edit.py -a_srs"});
  const std::string heights = RasterFile{.unit = "ft"}.write(path("heights.tif"));
  expect_input_error([&] { read_terrain(heights); }, {"heights.tif", "in feet", "gdal_calc.py", "0.3048"});
}

/// Who followed "declare it as missing" took heights away, one value at a time.
TEST_F(Terrains, HeightsInDecimetresAreToldHowToConvert) {
  const std::string dem = RasterFile{.values = std::vector<double>(80, 22493.0)}.write(path("dm.tif"));
  expect_input_error([&] { read_terrain(dem); },
                     {"dm.tif", "22493", "not in metres", "gdal_calc.py", "A*0.1", "decimetres"});
  const std::string missing = RasterFile{.values = std::vector<double>(80, 3.4e38)}.write(path("none.tif"));
  try {
    read_terrain(missing);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()).find("not in metres"), std::string::npos) << e.what();
  }
}

TEST_F(Terrains, HeightsOfACompoundSystemMustBeInMetres) {
  const std::string depths = RasterFile{.system = "EPSG:32632+5715"}.write(path("depths.tif"));  // MSL depth
  expect_input_error([&] { read_terrain(depths); }, {"depths.tif", "heights count downwards", "--calc='-A'"});
  EXPECT_NO_THROW(read_terrain(RasterFile{.system = "EPSG:32632+5773"}.write(path("metres.tif"))));  // EGM96 height
  const std::string feet = RasterFile{.system = "EPSG:32610+6360"}.write(path("feet.tif"));  // NAVD88 height (ftUS)
  expect_input_error([&] { read_terrain(feet); }, {"feet.tif", "US survey foot", "must be metres", "gdal_calc.py"});
}

TEST_F(Terrains, HeightsOfACompoundSystemCountInFormatsWithoutAUnitOfTheBandToo) {
  RasterFile{.system = "EPSG:32610"}.write(path("dem.tif"));
  const std::string dem = write_text(
      "dem.vrt",
      "<VRTDataset rasterXSize='10' rasterYSize='8'><SRS>EPSG:32610+6360</SRS>"
      "<GeoTransform>600000, 10, 0, 5200080, 0, -10</GeoTransform><VRTRasterBand dataType='Float32' band='1'>"
      "<SimpleSource><SourceFilename "
      "relativeToVRT='1'>dem.tif</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
  expect_input_error([&] { read_terrain(dem); }, {"dem.vrt", "NAVD88", "US survey foot", "gdal_calc.py"});
}

/// A system of EPSG with an axis of ellipsoidal heights, as WKT.
std::string with_heights(int code) {
  OGRSpatialReference system;
  system.importFromEPSG(code);
  system.PromoteTo3D(nullptr);
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  system.exportToWkt(&text, options);
  const std::string wkt = text;
  CPLFree(text);
  return wkt;
}

TEST_F(Terrains, AnAxisOfHeightsIsChecked) {  // GeoPackages cannot hold such a system
  std::string wkt = with_heights(32632);
  const Terrain terrain = read_terrain(RasterFile{.system = wkt}.write(path("dem.tif")));
  OGRSpatialReference map;
  ASSERT_EQ(map.importFromWkt(terrain.geo.crs_wkt.c_str()), OGRERR_NONE);
  EXPECT_EQ(map.GetAxesCount(), 2);
  EXPECT_EQ(crs_name(terrain.geo.crs_wkt), "EPSG:32632 (WGS 84 / UTM zone 32N)");
  EXPECT_TRUE(terrain.warnings.empty());

  const std::string metre = "LENGTHUNIT[\"metre\",1,ID[\"EPSG\",9001]]";
  const std::size_t unit = wkt.rfind(metre);  // of the third axis
  ASSERT_NE(unit, std::string::npos) << wkt;
  wkt.replace(unit, metre.size(), "LENGTHUNIT[\"foot\",0.3048]");
  const std::string file = RasterFile{.system = wkt}.write(path("feet.tif"));
  expect_input_error([&] { read_terrain(file); }, {"feet.tif", "heights are in 'foot'", "must be metres",
                                                   "gdal_calc.py", "A*0.3048' --type=Float32"});
}

TEST_F(Terrains, LocalSystemsInMetresAreTaken) {
  const std::string local = "LOCAL_CS[\"quarry\",UNIT[\"metre\",1],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]]";
  EXPECT_NO_THROW(read_terrain(RasterFile{.place = {0, 1, 0, 8, 0, -1}, .system = local}.write(path("local.tif"))));
}

TEST_F(Terrains, ASystemThatStretchesDistancesIsRefused) {  // Web Mercator: 1 / cos(latitude), at 47.05 N 1.4676
  const std::string web =
      RasterFile{.place = {1261249.0, 10, 0, 5953000.0, 0, -10}, .system = "EPSG:3857"}.write(path("web.tif"));
  expect_input_error([&] { read_terrain(web); },
                     {"web.tif", "Pseudo-Mercator", "longer", "gdalwarp -t_srs EPSG:32632"});
}

TEST_F(Terrains, SizeAndCellsHaveBounds) {
  const std::string thin = RasterFile{.columns = 1, .rows = 8}.write(path("thin.tif"));
  expect_input_error([&] { read_terrain(thin); }, {"thin.tif", "1 x 8", "2 x 2"});
  const std::string coarse = RasterFile{.place = {6e5, 200, 0, 5.2e6, 0, -200}}.write(path("coarse.tif"));
  expect_input_error([&] { read_terrain(coarse); }, {"coarse.tif", "200 m", "0.05 to 100 m"});
}

TEST_F(Terrains, OtherBandsAreNamedAndComplexOnesRefused) {
  EXPECT_TRUE(said(read_terrain(RasterFile{.bands = 3}.write(path("dem.tif"))).warnings, "has 3 bands"));
  const std::string complex = RasterFile{.type = GDT_CFloat32}.write(path("complex.tif"));
  expect_input_error([&] { read_terrain(complex); }, {"complex.tif", "complex numbers"});
}

TEST_F(Terrains, AnAsciiGridIsReadAndToldHowToGetASystem) {
  const std::string text =
      "ncols 2\nnrows 2\nxllcorner 600000\nyllcorner 5200000\ncellsize 5\nNODATA_value -9999\n1 2\n3 -9999\n";
  const std::string dem = write_text("dem.asc", text);
  expect_input_error([&] { read_terrain(dem); }, {"dem.asc", "no coordinate system", "gdal_translate -a_srs EPSG:..."});
  OGRSpatialReference srs;
  srs.importFromEPSG(32632);
  char* wkt = nullptr;
  srs.exportToWkt(&wkt);
  write_text("dem.prj", wkt);
  CPLFree(wkt);
  const Terrain t = read_terrain(dem);
  EXPECT_FLOAT_EQ(t.heights.at(0, 0), 3.0F);
  EXPECT_FLOAT_EQ(t.heights.at(1, 1), 2.0F);
  EXPECT_TRUE(std::isnan(t.heights.at(1, 0)));
  EXPECT_DOUBLE_EQ(t.heights.grid.cell_x, 5.0);
}

/// A raster of several pieces: 2 million cells each. Heights follow from the place.
RasterFile large_raster() {
  RasterFile file{.columns = 2100, .rows = 2100};
  for (int row = 0; row < file.rows; ++row)
    for (int column = 0; column < file.columns; ++column) file.values.push_back(500.0 + 0.25 * row + 0.125 * column);
  return file;
}

TEST_F(Terrains, ThreadsDoNotChangeTheHeights) {
  const std::string dem = large_raster().write(path("dem.tif"));
  const Terrain one = read_terrain(dem), four = read_terrain(dem, {}, 4);
  for (const auto& [column, row] : {std::pair{0, 0}, {2099, 0}, {1050, 1234}, {2099, 2099}})
    EXPECT_FLOAT_EQ(four.heights.at(column, row), static_cast<float>(500.0 + 0.25 * (2099 - row) + 0.125 * column));
  EXPECT_TRUE(std::ranges::equal(one.heights.values, four.heights.values));
}

TEST_F(Terrains, AMosaicOfTilesIsReadByThreadsToo) {  // a VRT of two, with a strip of 50 cells between them
  const auto tile = [this](const std::string& name, int columns, double west) {
    RasterFile file{.columns = columns, .rows = 2100, .place = {west, 10.0, 0.0, 5200080.0, 0.0, -10.0}};
    for (int row = 0; row < file.rows; ++row)
      for (int column = 0; column < columns; ++column)
        file.values.push_back(500.0 + 0.25 * row + 0.0125 * (west - 600000.0) + 0.125 * column);
    file.nodata = -9999.0;
    return file.write(path(name));
  };
  const std::string west = tile("west.tif", 1050, 600000.0), east = tile("east.tif", 1000, 611000.0);
  const char* const tiles[] = {west.c_str(), east.c_str(), nullptr};
  const std::string mosaic = path("mosaic.vrt");
  GDALClose(GDALBuildVRT(mosaic.c_str(), 2, nullptr, tiles, nullptr, nullptr));
  const Terrain one = read_terrain(mosaic), four = read_terrain(mosaic, {}, 4);
  ASSERT_EQ(four.heights.grid.columns, 2100);
  for (int row = 0; row < 2100; ++row)
    for (int column = 0; column < 2100; ++column) {
      const auto expected = static_cast<float>(500.0 + 0.25 * (2099 - row) + 0.125 * column);
      const float is = four.heights.at(column, row), alone = one.heights.at(column, row);
      const bool gap = column >= 1050 && column < 1100;
      ASSERT_TRUE(gap ? std::isnan(is) && std::isnan(alone) : is == expected && alone == expected)
          << column << ", " << row << ": " << is;
    }
}

TEST_F(Terrains, ThreadsDoNotChangeTheFaultThatIsNamed) {
  RasterFile file = large_raster();
  for (const int row : {300, 1100, 1101, 2099}) file.values[static_cast<std::size_t>(row) * 2100 + 17] = 99999.0;
  const std::string dem = file.write(path("dem.tif"));
  for (const int threads : {1, 2, 4})
    expect_input_error([&] { read_terrain(dem, {}, threads); }, {"99999 m", "column 17, row 300 "});
}

TEST_F(Terrains, WhatIsNoRasterIsRefused) {
  expect_input_error([&] { read_terrain(path("nothing.tif")); }, {"nothing.tif", "cannot be opened"});
  const std::string text = write_text("text.tif", "hello");
  expect_input_error([&] { read_terrain(text); }, {"text.tif", "cannot be opened"});
}

TEST_F(Terrains, ATruncatedFileIsRefused) {
  const std::string dem = RasterFile{.columns = 300, .rows = 300}.write(path("dem.tif"));
  std::filesystem::resize_file(dem, 100000);
  expect_input_error([&] { read_terrain(dem); }, {"dem.tif", "cannot be"});
}

}  // namespace talus::io::test
