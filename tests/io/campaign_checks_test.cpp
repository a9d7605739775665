#include <algorithm>
#include <cmath>

#include "files.hpp"
#include "talus/io/campaign/campaign_file.hpp"

namespace talus::io::test {
namespace {

/// A slope of 45 degrees that rises to the SOUTH: z = 1075 - y + (x - 5) / 10 from the corner of the DEM.
class CampaignChecks : public Files {
 protected:
  CampaignChecks() { RasterFile{}.write(path("dem.tif")); }

  std::vector<std::string> warnings(const std::string& blocks, const std::string& stops = "",
                                    const std::string& errors = "", const std::string& files = "") {
    write_text("blocks.csv", blocks);
    if (!stops.empty()) write_text("stops.csv", stops);
    return read_campaign(write_text("c.toml", "dem = \"dem.tif\"\nblocks = \"blocks.csv\"\n" +
                                                  std::string(stops.empty() ? "" : "stops = \"stops.csv\"\n") + files +
                                                  "[measurement_error]\n" + errors))
        .warnings;
  }

  std::vector<std::string> deposits(const std::string& table) {
    write_text("deposits.csv", table);
    if (!std::filesystem::exists(path("s.gpkg")))
      write_vector(path("s.gpkg"), "EPSG:32632", {}, {{"POLYGON((10 10,60 10,60 20,10 20,10 10))"}});
    if (!std::filesystem::exists(path("mapped.gpkg")))
      write_vector(path("mapped.gpkg"), "EPSG:32632", {}, {{"POLYGON((10 20,90 20,90 70,10 70,10 20))"}});
    return read_campaign(write_text("d.toml",
                                    "dem = \"dem.tif\"\n[deposits]\nsources = \"s.gpkg\"\nmapped = \"mapped.gpkg\"\n"
                                    "[measurement_error]\n"))
        .warnings;
  }

  static void one(const std::vector<std::string>& said, const std::vector<std::string>& parts) {
    ASSERT_EQ(said.size(), 1U) << testing::PrintToString(said);
    for (const std::string& part : parts) EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
  }
};

constexpr const char* kHead = "id,x,y,release_height_m,mass_kg\n";

/// Rows of five blocks that differ in their ids alone.
std::string five(const std::string& cells, std::size_t count = 5) {
  std::string rows;
  for (std::size_t i = 0; i < count; ++i) rows += std::string(1, static_cast<char>('a' + i)) + "," + cells + "\n";
  return rows;
}

/// Places of rest with deviations of 14.14 m east and 0 north: 10 m in a coordinate. An error typed in cm was taken,
/// and made a wrong model look right.
TEST_F(CampaignChecks, AnErrorOfPlacesAboveHalfOfTheirSpread) {
  const std::string blocks = kHead + five("600050,5200020,1,500");
  const std::string stops =
      "id,x,y\na,600030,5200050\nb,600040,5200050\nc,600050,5200050\nd,600060,5200050\ne,600070,5200050\n";
  EXPECT_TRUE(warnings(blocks, stops, "position_m = 5\n").empty());
  one(warnings(blocks, stops, "position_m = 5.1\n"),
      {"c.toml: [measurement_error] position_m = 5.1: is more than half", "places of rest",
       "standard deviation is 10 m (5 values)", "in m, such as 0.3 for 30 cm"});
  EXPECT_TRUE(warnings(blocks, stops.substr(0, stops.find('e')), "position_m = 50\n").empty());  // 4: no spread yet
}

TEST_F(CampaignChecks, OtherErrorsAboveHalfOfTheSpread) {
  write_text("screens.csv", "id,wkt\nS1,\"LINESTRING (600010 5200040, 600090 5200040)\"\n");
  write_text("passages.csv",
             "id,screen,speed_ms,jump_height_m,angular_velocity_rads\n"
             "a,S1,2,1,10\nb,S1,4,2,20\nc,S1,6,3,30\nd,S1,8,4,40\ne,S1,10,5,50\n");
  const std::string blocks = kHead + five("600050,5200020,1,500");
  const auto said = [&](const std::string& errors) {
    return warnings(blocks, "", errors, "passages = \"passages.csv\"\nscreens = \"screens.csv\"\n");
  };
  // deviations: 2.83 m/s at a mean of 6, 1.41 m, 14.1 rad/s at a mean of 30
  EXPECT_TRUE(said("speed_fraction = 0.235\njump_height_m = 0.7\nangular_velocity_fraction = 0.235\n").empty());
  one(said("speed_fraction = 0.237\n"), {"speed_fraction = 0.237, 1.42 m/s of the mean: is more than half",
                                         "2.83 m/s (5 values)", "is it a share, such as 0.03 for 3 %?"});
  one(said("jump_height_m = 0.71\n"), {"jump_height_m = 0.71: is more", "1.41 m (5 values)"});
  one(said("angular_velocity_fraction = 0.237\n"), {"angular_velocity_fraction = 0.237", "14.1 rad/s"});
}

TEST_F(CampaignChecks, HighReleases) {  // the relief of the DEM is 79 m
  EXPECT_TRUE(warnings(std::string(kHead) + "a,600050,5200020,50,500\n").empty());
  one(warnings(std::string(kHead) + "a,600050,5200020,300,500\nb,600050,5200020,3,500\n"),
      {"blocks.csv: 1 of 2 blocks are released higher above the ground than 50 m: a (300 m); is release_height_m in "
       "m"});
  const auto with_relief = [&](int most) {
    RasterFile low;
    for (int i = 0; i < 80; ++i) low.values.push_back(1000.0 + most * (i % 10) / 9.0);
    low.write(path("dem.tif"));
  };
  with_relief(18);
  EXPECT_TRUE(warnings(std::string(kHead) + "a,600050,5200020,18,500\n").empty());
  one(warnings(std::string(kHead) + "a,600050,5200020,19,500\n"), {"than 18 m, the relief of the DEM: a (19 m)"});
  with_relief(0);  // a drop test on a slab
  EXPECT_TRUE(warnings(std::string(kHead) + "a,600050,5200020,10,500\n").empty());
  one(warnings(std::string(kHead) + "a,600050,5200020,11,500\n"), {"than 10 m: a (11 m)"});
}

/// The unit normal is (-0.1, 1, 1) / 1.4177.
TEST_F(CampaignChecks, SpeedsOutOfTheGround) {
  const auto said = [&](const std::string& velocity) {
    return warnings("id,x,y,release_height_m,mass_kg,vx,vy,vz\na,600050,5200020,1,500," + velocity + "\n");
  };
  EXPECT_TRUE(said("0,0,14").empty());
  one(said("0,0,15"), {"1 of 1 blocks leave the ground upwards at more than 10 m/s", "a (vz 15 m/s)", "sign of vz"});
  EXPECT_EQ(said("0,10,5").size(), 1U);    // 10.6 m/s out of the ground
  EXPECT_TRUE(said("0,-10,5").empty());    // up the slope
  EXPECT_TRUE(said("0,16,-0.5").empty());  // over its edge
}

/// The release may lift a block 1 m and 0.05 m, the error of the place 1.51 m, that of the DEM 0.5 m: 3.06 m.
TEST_F(CampaignChecks, StopsAboveTheirReleases) {
  const auto said = [&](const std::string& stop, const std::string& radius) {
    return warnings("id,x,y,release_height_m,mass_kg,vy,release_radius_m\na,600050,5200030,1,500,-1," + radius +
                        "\nb,600050,5200030,1,500,-1,0\n",
                    "id,x,y\nb,600050,5200060\na,600050," + stop + "\n", "position_m = 0.5\n");
  };
  EXPECT_TRUE(said("5200027", "0").empty());
  one(said("5200026.8", "0"), {"stops.csv: 1 of 2 blocks came to rest higher above the ground at their release",
                               ": a (3.2 m); no block can get there", "exchanged?"});
  EXPECT_TRUE(said("5200026.8", "2").empty());
  EXPECT_EQ(said("5200024.5", "2").size(), 1U);
}

TEST_F(CampaignChecks, StopsWithoutGround) {
  RasterFile dem;
  for (int i = 0; i < 80; ++i) dem.values.push_back(i % 10 == 9 ? -9999.0 : 1000.0 + 10.0 * (i / 10));
  dem.nodata = -9999.0;
  dem.write(path("dem.tif"));
  const std::vector<std::string> said =
      warnings(std::string(kHead) + "a,600050,5200020,1,500\n", "id,x,y\na,600097,5200050\n");
  EXPECT_TRUE(std::ranges::any_of(said, [](const std::string& line) {
    return line.find("1 of 1 blocks came to rest where the DEM has no heights") != line.npos;
  })) << testing::PrintToString(said);
}

TEST_F(CampaignChecks, ASecondStopIsRefused) {
  for (const char* second : {"a,600052,5200041,", "a,,,400"})
    expect_input_error(
        [&] {
          warnings(kHead + five("600050,5200020,1,500"),
                   std::string("id,x,y,mass_kg\na,600050,5200040,\n") + second + "\n");
        },
        {"stops.csv:3: id = 'a': is there already in line 2"});
}

/// Ellipsoids of 1414 kg and cuboids of 2700 kg: masses of both are right.
TEST_F(CampaignChecks, MassesThatAllDiffer) {
  const auto said = [&](const std::string& mass, std::size_t count = 5) {
    return warnings("id,x,y,release_height_m,mass_kg,L1_m,L2_m,L3_m\n" +
                    five("600050,5200020,1," + mass + ",1,1,1", count));
  };
  EXPECT_TRUE(said("960").empty());
  EXPECT_TRUE(said("2700").empty());
  one(said("930"), {"the masses of 5 blocks are 0.66 times those of ellipsoids", "are masses in kg"});
  one(said("3118"), {"are 2.2 times those of ellipsoids", "1 to 1.9 times"});  // pounds
  EXPECT_TRUE(said("3118", 4).empty());
}

TEST_F(CampaignChecks, NamesOfColumnsInAnyCaseAndRemarks) {
  one(warnings("ID,X,Y,Release_Height_m,MASS_KG,Remark,Note\na,600050,5200020,1,500,mossy,old\n"),
      {"blocks.csv: columns remark, note: not read"});
  EXPECT_TRUE(warnings("ID,X,Y,Release_Height_m,MASS_KG,l1_m,L2_M,l3_m\na,600050,5200020,1,500,1,1,0.5\n").empty());
  expect_input_error([&] { warnings("ID,id,x,y,release_height_m,mass_kg\na,a,600050,5200020,1,500\n"); },
                     {"blocks.csv:1: column 'id' is there twice"});
  expect_input_error([&] { warnings("id,x,y,release_height_m,mass_kg,colour\na,600050,5200020,1,500,red\n"); },
                     {"blocks.csv:1: unknown column 'colour'"});
}

TEST_F(CampaignChecks, ALayerIsNoTable) {
  write_vector(path("blocks.gpkg"), "EPSG:32632", {}, {{"POINT(50 50)"}});
  std::ifstream file(path("blocks.gpkg"), std::ios::binary);
  const std::string layer{std::istreambuf_iterator<char>(file), {}};
  for (const std::string& text : {layer, std::string("{\"type\": \"FeatureCollection\"}")})
    expect_input_error([&] { warnings(text); },
                       {"blocks.csv: is a layer of vectors", "CSV only", "Export > Save Features As > CSV", "AS_XY"});
}

TEST_F(CampaignChecks, MassAndDiameterOfMappedBlocks) {
  const std::string head = "id,x,y,diameter_m,mass_kg\n";  // a sphere of 1 m has 1414 kg
  EXPECT_TRUE(deposits(head + five("600050,5200040,1,2000")).empty());
  EXPECT_TRUE(deposits(head + five("600050,5200040,1,")).empty());
  one(deposits(head + five("600050,5200040,1,3000")), {"mass_kg, which counts, is 2.1 times the mass of a sphere"});
  EXPECT_TRUE(deposits(head + five("600050,5200040,1,3000", 4)).empty());
  expect_input_error([&] { deposits(head + five("600050,5200040,1,4300")); },
                     {"deposits.csv:2: diameter_m = '1': is that of a sphere of 1414 kg", "mass_kg = 4300"});
  expect_input_error([&] { deposits("id,x,y\na,600050,5200040\n"); },
                     {"deposits.csv:1: has no column mass_kg or diameter_m"});
}

/// Blocks a, b, ... of which some lie outside the polygon.
TEST_F(CampaignChecks, BlocksOutsideTheMappedPolygons) {
  const auto table = [](std::size_t outside) {
    std::string rows = "id,x,y,diameter_m\n";
    for (std::size_t i = 0; i < 10; ++i)
      rows += std::string(1, static_cast<char>('a' + i)) + (i < outside ? ",600007" : ",600050") + ",5200040,1\n";
    return rows;
  };
  EXPECT_TRUE(deposits(table(0)).empty());
  const std::vector<std::string> few = deposits(table(1)), many = deposits(table(2)), half = deposits(table(5));
  one(few, {"1 of 10 blocks lie outside the mapped polygons and are left out: a"});
  EXPECT_TRUE(few[0].ends_with(": a")) << few[0];
  one(many, {"are left out: a, b; these are so many", "draw the polygons round", "delete the rows"});
  one(half, {"5 of 10 blocks"});
  expect_input_error([&] { deposits(table(6)); },
                     {"deposits.csv: 6 of 10 blocks lie outside the mapped polygons, more than half: a, b, c, d, e, f",
                      "draw the polygons round", "delete the rows"});
}

TEST_F(CampaignChecks, HighReleasesFromSources) {
  write_vector(path("s.gpkg"), "EPSG:32632", {{"release_height", OFTReal}},
               {{"POLYGON((10 10,60 10,60 20,10 20,10 10))", {"60"}}});
  one(deposits("id,x,y,diameter_m\na,600050,5200040,1\n"),
      {"s.gpkg: blocks are released up to 60 m above the ground, more than 50 m", "not the height of the cliff?"});
}

}  // namespace
}  // namespace talus::io::test
