#include "talus/io/gdal/crs.hpp"

#include "files.hpp"
#include "talus/io/gdal/vectors.hpp"
#include "talus/io/gdal/zones.hpp"

namespace talus::io::test {

using Crs = Files;

// The map of gar.tif: 5 m cells in EPSG:31287 (MGI / Austria Lambert).
Terrain austria(const std::string& path, double cell = 5.0) {
  return read_terrain(
      RasterFile{.columns = 100, .rows = 100, .place = {247700, cell, 0, 352200, 0, -cell}, .system = "EPSG:31287"}
          .write(path));
}

// `echo 11.33 47.05 | gdaltransform -s_srs EPSG:4326 -t_srs EPSG:31287` gives 247893.896281695 352011.684627846.
TEST_F(Crs, DegreesBecomeMetres) {
  const Terrain terrain = austria(path("dem.tif"));
  const std::string file = write_vector(path("s.gpkg"), "EPSG:4326", {}, {{"POINT(11.33 47.05)"}});
  const SourceLayer layer = read_sources(file, terrain, {1, 1});
  ASSERT_EQ(layer.cells.size(), 1U);
  EXPECT_NEAR(layer.cells[0].x, 247893.896281695 - 247700.0, 1e-4);
  EXPECT_NEAR(layer.cells[0].y, 352011.684627846 - (352200.0 - 500.0), 1e-4);
  ASSERT_EQ(layer.reprojections.size(), 1U);
  EXPECT_EQ(layer.reprojections[0].role, "sources");
  EXPECT_NE(layer.reprojections[0].operation.find("MGI to WGS 84"), std::string::npos)
      << layer.reprojections[0].operation;
  EXPECT_DOUBLE_EQ(layer.reprojections[0].accuracy_m.value_or(0.0), 1.5);  // EPSG: MGI to WGS 84 (3)
  EXPECT_TRUE(layer.warnings.empty());                                     // 1.5 m is better than half of 5 m
}

TEST_F(Crs, AnAccuracyWorseThanHalfACellIsToldWithItsOperation) {
  const std::string file = write_vector(path("s.gpkg"), "EPSG:4326", {}, {{"POINT(11.33 47.05)"}});
  const SourceLayer layer = read_sources(file, austria(path("fine.tif"), 2.9), {1, 1});
  EXPECT_TRUE(said(layer.warnings, "accurate to 1.5 m only"));
  EXPECT_TRUE(said(layer.warnings, "MGI to WGS 84"));
}

TEST_F(Crs, AnUnknownAccuracyIsTold) {  // PROJ knows no way from NAD27 to MGI but a "ballpark"
  const std::string file = write_vector(path("s.gpkg"), "EPSG:4267", {}, {{"POINT(11.33 47.05)"}});
  const SourceLayer layer = read_sources(file, austria(path("dem.tif")), {1, 1});
  ASSERT_EQ(layer.reprojections.size(), 1U);
  EXPECT_FALSE(layer.reprojections[0].accuracy_m);
  EXPECT_TRUE(said(layer.warnings, "of unknown accuracy"));
}

TEST_F(Crs, TheSameSystemWrittenOtherwiseIsTheSame) {  // ESRI's .prj has other names and no code
  const Terrain terrain = austria(path("dem.tif"));
  const std::string file =
      write_vector(path("s.shp"), "EPSG:31287", {{"a", OFTInteger}}, {{"POINT(247800 352000)"}}, wkbPoint);
  const SourceLayer layer = read_sources(file, terrain, {1, 1});
  EXPECT_TRUE(layer.reprojections.empty());
  EXPECT_DOUBLE_EQ(layer.cells[0].x, 100.0);
  EXPECT_DOUBLE_EQ(layer.cells[0].y, 300.0);
}

TEST_F(Crs, APlaceThatCannotBeTransformedIsNamed) {
  const Terrain terrain = austria(path("dem.tif"));
  const std::string file = write_vector(path("s.gpkg"), "EPSG:4326", {}, {{"POINT(11.33 947.05)"}});
  expect_input_error(
      [&] {
        read_sources(file, terrain, {1, 1});
      },
      {"s.gpkg: feature 1", "11.33, 947.05", "cannot be transformed", "EPSG:4326", "EPSG:31287"});
}

TEST_F(Crs, ALocalSystemHasNoWayToAnotherOne) {
  const std::string local = "LOCAL_CS[\"quarry\",UNIT[\"metre\",1],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]]";
  const Terrain terrain =
      read_terrain(RasterFile{.place = {0, 1, 0, 8, 0, -1}, .system = local}.write(path("dem.tif")));
  const std::string file =
      write_vector(path("s.shp"), "EPSG:31287", {{"a", OFTInteger}}, {{"POINT(247800 352000)"}}, wkbPoint);
  expect_input_error(
      [&] {
        read_sources(file, terrain, {1, 1});
      },
      {"s.shp", "no transformation", "quarry", "EPSG:31287"});
}

/// A local grid in metres.
std::string grid_named(const std::string& name) {
  return "LOCAL_CS[\"" + name + "\",UNIT[\"metre\",1],AXIS[\"X\",EAST],AXIS[\"Y\",NORTH]]";
}

TEST_F(Crs, LocalGridsWithOtherNamesAreTakenAsTheSameWithAWarning) {
  const RasterFile mine{.place = {0, 1, 0, 8, 0, -1}, .system = grid_named("mine grid")};
  const Terrain terrain = read_terrain(mine.write(path("dem.tif")));
  int number = 0;
  const auto warnings = [&](const std::string& name) {
    const std::string file =
        write_vector(path("s" + std::to_string(number++) + ".gpkg"), grid_named(name), {}, {{"POINT(3.5 4.5)"}});
    const SourceLayer layer = read_sources(file, terrain, {1, 1});
    EXPECT_DOUBLE_EQ(layer.cells.at(0).x, 3.5) << name;
    return layer.warnings;
  };
  EXPECT_TRUE(said(warnings("old pit grid"),
                   "s0.gpkg: says the local grid 'old pit grid', the DEM 'mine grid': taken as the same grid"));
  for (const char* same : {"mine grid", "Mine Grid", "unknown", "Unnamed", ""})
    EXPECT_TRUE(warnings(same).empty()) << same;

  RasterFile old = mine;  // rasters are looked up from the DEM, the other way round
  old.system = grid_named("old pit grid");
  old.type = GDT_Byte;
  old.values.assign(80, 1.0);
  const ZoneRequest zones{.path = old.write(path("zones.tif")), .field = {}, .names = {"1"}};
  EXPECT_TRUE(said(read_zones(zones, terrain).warnings,
                   "zones.tif: says the local grid 'old pit grid', the DEM 'mine grid': taken as the same grid"));
}

TEST_F(Crs, NamesHaveTheirCode) {
  OGRSpatialReference srs;
  srs.importFromEPSG(31287);
  char* wkt = nullptr;
  srs.exportToWkt(&wkt);
  EXPECT_EQ(crs_name(wkt), "EPSG:31287 (MGI / Austria Lambert)");
  CPLFree(wkt);
}

}  // namespace talus::io::test
