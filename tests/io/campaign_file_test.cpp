#include "talus/io/campaign/campaign_file.hpp"

#include <algorithm>
#include <cmath>

#include "files.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/fit/campaign/deposits.hpp"
#include "talus/io/campaign/model_file.hpp"

namespace talus::io::test {
namespace {

constexpr const char* kBlocks =
    "id,x,y,release_height_m,vx,vy,vz,mass_kg,density_kgm3,L1_m,L2_m,L3_m,day,group,rock,holdout\n"
    "a,600050,5200040,1.5,0,-1,0,1000,2650,1.1,0.9,0.7,3,g,K2,0\n"
    "b,600060,5200040,2,,,,500,,,,,,,,1\n";

class Campaigns : public Files {
 protected:
  Campaigns() {
    RasterFile{}.write(path("dem.tif"));
    write_text("blocks.csv", kBlocks);
    write_text("screens.csv", "id,wkt\nS1,\"LINESTRING (600010 5200020, 600090 5200020)\"\n");
  }

  LoadedCampaign read(const std::string& more = "") {
    const std::string exact = more.find("[measurement_error]") == more.npos ? "[measurement_error]\n" : "";
    return read_campaign(write_text("c.toml", "dem = \"dem.tif\"\nblocks = \"blocks.csv\"\n" + more + exact));
  }
  void refused(const std::string& more, const std::vector<std::string>& parts) {
    expect_input_error([&] { read(more); }, parts);
  }
};

TEST_F(Campaigns, BlocksInLocalMetres) {
  const Campaign c = read("crs = \"EPSG:32632\"\n").campaign;
  ASSERT_EQ(c.blocks.size(), 2U);
  const MeasuredBlock &a = c.blocks[0], &b = c.blocks[1];
  EXPECT_EQ(a.x, 50.0);
  EXPECT_EQ(a.y, 40.0);
  EXPECT_EQ(a.velocity, Vec3(0, -1, 0));
  EXPECT_EQ(a.axes, Vec3(1.1, 0.9, 0.7));
  EXPECT_EQ(a.day, 3);
  EXPECT_EQ(a.group, "g");
  EXPECT_EQ(a.rock, "K2");
  EXPECT_EQ(b.rock, "");
  EXPECT_FALSE(a.holdout);
  EXPECT_TRUE(b.holdout);
  EXPECT_EQ(b.density, 2700.0);
  EXPECT_EQ(b.velocity, Vec3::Zero());
  EXPECT_NEAR(b.axes[0] * b.axes[1] * b.axes[2] * kPi / 6.0 * 2700.0, 500.0, 1e-9);  // a sphere of that mass
  EXPECT_EQ(b.axes[0], b.axes[2]);
  EXPECT_EQ(c.zone_names, std::vector<std::string>{"default"});
}

TEST_F(Campaigns, Measurements) {
  write_text("stops.csv", "id,x,y,mass_kg\na,600052.5,5200010,\nb,,,\n");
  write_text("passages.csv",
             "id,screen,speed_ms,jump_height_m,angular_velocity_rads\na,S1,12.5,,3\na,S1,99,9,9\nb,S1,,,\n");
  write_text("samples.csv", "id,x,y,z,speed_ms,angular_velocity_rads\na,600053,5200036,,7,\n");
  const LoadedCampaign loaded = read(
      "stops = \"stops.csv\"\npassages = \"passages.csv\"\nscreens = \"screens.csv\"\nsamples = \"samples.csv\"\n"
      "[measurement_error]\nposition_m = 0.5\nspeed_fraction = 0.02\n");
  const Campaign& c = loaded.campaign;
  ASSERT_TRUE(c.blocks[0].stop.has_value());
  EXPECT_EQ(*c.blocks[0].stop, Eigen::Vector2d(52.5, 10.0));
  EXPECT_FALSE(c.blocks[0].stop_mass.has_value());
  EXPECT_FALSE(c.blocks[1].stop.has_value());
  ASSERT_TRUE(c.blocks[0].passages[0].has_value());
  EXPECT_EQ(c.blocks[0].passages[0]->speed, 12.5);  // the first row counts
  EXPECT_TRUE(std::isnan(c.blocks[0].passages[0]->jump));
  EXPECT_TRUE(c.blocks[1].passages[0].has_value());  // it crossed, though nothing was measured
  ASSERT_EQ(c.blocks[0].samples.size(), 1U);
  EXPECT_NEAR(c.blocks[0].samples[0].distance, 5.0, 1e-9);  // 3, 4, 5
  EXPECT_TRUE(std::isnan(c.blocks[0].samples[0].spin));
  EXPECT_EQ(c.error.position_m, 0.5);
  EXPECT_EQ(c.error.jump_height_m, 0.0);
  EXPECT_EQ(loaded.inputs.size(), 7U);
}

TEST_F(Campaigns, DoubledPassagesAreSaidOnce) {
  const std::string rows = "id,screen,speed_ms\na,S1,12\nb,S1,5\n";
  const auto warnings = [&](const std::string& more) {
    write_text("passages.csv", rows + more);
    return read("passages = \"passages.csv\"\nscreens = \"screens.csv\"\n").warnings;
  };
  EXPECT_TRUE(warnings("").empty());
  const std::vector<std::string> one = warnings("a,S1,99\n"), two = warnings("a,S1,99\nb,S1,1\n");
  ASSERT_EQ(one.size(), 1U);
  EXPECT_TRUE(one[0].ends_with("passages.csv:4: block 'a' has a passage of screen 'S1' already: the first one counts"))
      << one[0];
  ASSERT_EQ(two.size(), 1U);
  EXPECT_TRUE(two[0].ends_with("the first one counts; so it is in 1 more rows")) << two[0];
}

TEST_F(Campaigns,
       DoubledSamplesCountOnce) {  // of another speed: two states at one place, as before and after an impact
  write_text("samples.csv", "id,x,y,speed_ms\na,600053,5200036,7\na,600053,5200036,9\na,600053,5200036,7\n");
  const LoadedCampaign loaded = read("samples = \"samples.csv\"\n");
  EXPECT_EQ(loaded.campaign.blocks[0].samples.size(), 2U);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_TRUE(loaded.warnings[0].ends_with("of which the first one counts: lines 4")) << loaded.warnings[0];
}

/// Three samples, the farthest one first in the file: a block meets them in the order of their distance.
TEST_F(Campaigns, SamplesAreReadNearestFirst) {
  write_text("samples.csv", "id,x,y,speed_ms\na,600050,5200072,9\na,600050,5200036,7\na,600050,5200052,8\n");
  const LoadedCampaign loaded = read("samples = \"samples.csv\"\n");
  std::vector<double> speeds;
  for (const Sample& sample : loaded.campaign.blocks[0].samples) speeds.push_back(sample.speed);
  EXPECT_EQ(speeds, (std::vector<double>{7.0, 8.0, 9.0}));
}

TEST_F(Campaigns, MassesInAnotherUnitAreSaid) {
  const std::string head = "id,x,y,release_height_m,mass_kg,L1_m,L2_m,L3_m\n", sphere = "b,600060,5200040,1,500,,,\n";
  const auto warnings = [&](const std::string& mass) {
    write_text("blocks.csv", head + "a,600050,5200040,1," + mass + ",1,1,1\n" + sphere);
    return read().warnings;
  };
  EXPECT_TRUE(warnings("2700").empty());  // a cube; its ellipsoid has 1414 kg
  EXPECT_TRUE(warnings("480").empty());
  for (const std::string mass : {"2.7", "460", "4300"}) {
    const std::vector<std::string> said = warnings(mass);
    ASSERT_EQ(said.size(), 1U);
    for (const char* part :
         {"blocks.csv: the mass of 1 of 2 blocks", "block 'a' has ", "its ellipsoid 1414 kg", "in kg"})
      EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
  }
  write_text("blocks.csv", head + "a,600050,5200040,1,4300,1,1,1\nb,600060,5200040,1,0.5,,,\n");
  write_text("stops.csv", "id,x,y,mass_kg\na,600052,5200010,6400\nb,600052,5200010,0.8\n");
  refused("stops = \"stops.csv\"\n", {"stops.csv:3", "mass_kg = '0.8'", "1.5 times the 0.5 kg", "in kg?"});
}

TEST_F(Campaigns, SizesInAnotherUnitAreSaid) {
  const auto warnings = [&](const std::string& mass) {
    write_text("blocks.csv", "id,x,y,release_height_m,mass_kg\na,600050,5200040,1," + mass + "\n");
    return read().warnings;
  };
  EXPECT_TRUE(warnings("45").empty());  // 0.32 m, the smallest blocks of Chant Sura
  for (const auto& [mass, part] : {std::pair{"1.35", "smaller than 0.098 m"}, {"135000000", "larger than 46 m"}}) {
    const std::vector<std::string> said = warnings(mass);
    ASSERT_EQ(said.size(), 1U);
    EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
    EXPECT_TRUE(said[0].ends_with("are masses in kg, lengths in m and densities in kg/m3?")) << said[0];
  }
}

TEST_F(Campaigns, SemicolonsAndTabsSeparateAsWell) {
  const std::string commas = "id,x,y,release_height_m,mass_kg,group\na,600050,5200040,1,500,\"A, west\"\n";
  write_text("blocks.csv", commas);
  EXPECT_EQ(read().campaign.blocks[0].group, "A, west");
  for (const char separator : {';', '\t'}) {  // as a spreadsheet writes them where the comma is not the list separator
    std::string other = commas;
    std::ranges::replace(other, ',', separator);
    write_text("blocks.csv", other);
    const MeasuredBlock block = read().campaign.blocks[0];
    EXPECT_EQ(block.x, 50.0);
    EXPECT_EQ(block.mass, 500.0);
    EXPECT_EQ(block.group, std::string("A") + separator + " west");
  }
  write_text("blocks.csv", "id;x;y;release_height_m;mass_kg\na;600050,5;5200040;1;500\n");
  refused("", {"blocks.csv:2: x = '600050,5'", "with a point for decimals"});
  write_text("blocks.csv", "id;x\ty;release_height_m;mass_kg\na;600050;5200040;1;500\n");
  refused("", {"blocks.csv:1: has a column 'id;x", "all by semicolons"});
  write_text("blocks.csv", "id;x;y;release_height_m;mass, kg\na;600050;5200040;1;500\n");
  refused("", {"blocks.csv:1: has a column 'id;x", "all by semicolons"});
  write_text("blocks.csv", "\n\nid;x;y;release_height_m;mass_kg\na;600050;5200040;1;500\n");
  EXPECT_EQ(read().campaign.blocks[0].mass, 500.0);
  write_text("blocks.csv", "id,x,y,release_height_m,mass_kg\ra,600050,5200040,1,500\r");
  refused("", {"blocks.csv:1: lines must end with a line feed", "not with CR alone"});
}

TEST_F(Campaigns, FaultsOfAllRowsAreListed) {
  write_text("blocks.csv",
             "id,x,y,release_height_m,mass_kg\na,600050,5200040,1,500\nb,0,0,1,500\nc,600050,5200040,1,heavy\n");
  refused("", {"blocks.csv:3: x = '0'", "(and 1 more fault)"});
  std::string rows = "id,x,y,diameter_m\n";
  for (int i = 0; i < 9; ++i) rows += "d" + std::to_string(i) + ",0,0,1\n";
  write_text("deposits.csv", rows);
  write_vector(path("s.gpkg"), "EPSG:32632", {}, {{"POLYGON((0 0,30 0,30 20,0 20,0 0))"}});
  const std::string campaign =
      write_text("d.toml", "dem = \"dem.tif\"\n[deposits]\nfile = \"deposits.csv\"\nsources = \"s.gpkg\"\n");
  try {
    read_campaign(campaign);
    FAIL() << "no error";
  } catch (const InputFaults& faults) {
    EXPECT_EQ(faults.count(), 9U);
    ASSERT_EQ(faults.faults().size(), 4U);
    EXPECT_TRUE(faults.faults()[3].ends_with("deposits.csv: and 6 more like this, in lines 5 to 10"));
  }
}

TEST_F(Campaigns, MeasurementsWithoutErrorsAreSaid) {
  const std::string start = "dem = \"dem.tif\"\nblocks = \"blocks.csv\"\n";
  const std::vector<std::string> said = read_campaign(write_text("c.toml", start)).warnings;
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find("c.toml: has no [measurement_error]"), std::string::npos) << said[0];
  EXPECT_TRUE(read_campaign(write_text("c.toml", start + "[measurement_error]\nposition_m = 0\n")).warnings.empty());
}

TEST_F(Campaigns, TextAfterAQuotedCellIsRefused) {
  const std::string head = "id,x,y,release_height_m,mass_kg\n";
  for (const std::string mass : {"\"50\"0", "\"\" \"500\"", "\"500\"kg"}) {  // "50"0 was read as 500
    write_text("blocks.csv", head + "a,600050,5200040,1," + mass + "\n");
    refused("", {"blocks.csv:2: text stands after a quotation mark"});
  }
  write_text("blocks.csv", head + "\"a\"\t,600050,5200040,1,\"500\" \r\n");
  const Campaign c = read().campaign;
  EXPECT_EQ(c.blocks[0].id, "a");
  EXPECT_EQ(c.blocks[0].mass, 500.0);
}

/// The DEM is a plane: the ground of a cell has the same area at its edge. A point in a cell of a polygon is a source
/// of its own, and takes nothing from the polygon, in whatever order they stand.
TEST_F(Campaigns, SourcesOfMappedBlocksCountByTheAreaOfTheirGround) {
  const Row area{"POLYGON((0 0,30 0,30 20,0 20,0 0))"}, point{"POINT(15 15)"};
  write_text("deposits.csv", "id,x,y,diameter_m\nd,600050,5200040,1\n");
  for (const std::vector<Row>& rows : {std::vector<Row>{area, point}, std::vector<Row>{point, area}}) {
    std::filesystem::remove(path("s.gpkg"));
    write_vector(path("s.gpkg"), "EPSG:32632", {}, rows);
    const Campaign c = read_campaign(write_text("c.toml",
                                                "dem = \"dem.tif\"\n[deposits]\nfile = \"deposits.csv\"\nsources = "
                                                "\"s.gpkg\"\n"))
                           .campaign;
    ASSERT_EQ(c.deposits->sources.size(), 7U);
    for (const DepositSource& source : c.deposits->sources)
      EXPECT_NEAR(source.area, source.point ? 100.0 : 100.0 * std::sqrt(1.0 + 0.1 * 0.1 + 1.0), 1e-9);
  }
}

TEST_F(Campaigns, PercentIsNoFraction) {
  refused("[measurement_error]\nspeed_fraction = 3\n", {"c.toml", "speed_fraction = 3", "0 to 1"});
}

TEST_F(Campaigns, AHeightSystemMovesNoPlace) {
  EXPECT_EQ(read("crs = \"EPSG:32632+5773\"\n").campaign.blocks[0].x, 50.0);
}

TEST_F(Campaigns, ZonesOfARaster) {
  RasterFile zones;
  zones.type = GDT_Byte;
  zones.values.assign(80, 1.0);
  zones.values[0] = 7.0;  // the north-western cell
  zones.write(path("zones.tif"));
  const LoadedCampaign loaded = read("zones = \"zones.tif\"\n[zone_names]\n1 = \"talus\"\n7 = \"rock\"\n");
  EXPECT_EQ(loaded.campaign.zone_names, (std::vector<std::string>{"default", "talus", "rock"}));
  EXPECT_EQ(loaded.campaign.zones.at(0, 7), 2);
  EXPECT_EQ(loaded.campaign.zones.at(5, 0), 1);
  refused("zones = \"zones.tif\"\n[zone_names]\n1 = \"talus\"\n",
          {"zones.tif", "zone '7'", "[zone_names]", "7 = \"NAME\""});
  refused("zones = \"zones.tif\"\n", {"c.toml:3", "[zone_names]"});
  refused("[zone_names]\n1 = \"talus\"\n", {"c.toml", "[zone_names] must come with", "zones = \"zones.tif\""});
  refused("zones = \"zones.tif\"\n[zone_names]\n1 = \"default\"\n7 = \"rock\"\n", {"c.toml:5", "another name"});
}

/// `code` of the fitted model could not hold them.
TEST_F(Campaigns, CodesOfZonesAreThoseOfAScenario) {
  RasterFile zones;
  zones.type = GDT_Int16;
  zones.values.assign(80, -1.0);
  zones.write(path("zones.tif"));
  const std::string head = "zones = \"zones.tif\"\n[zone_names]\n";
  refused(head + "\"-1\" = \"scree\"\n",
          {"c.toml:5: zone_names.-1 = 'scree': the code '-1' must be a whole number, 0 to 1e+15"});
  refused(head + "x = \"rock\"\n", {"c.toml:5", "the code 'x' must be a whole number, 0 to 1e+15"});
  refused(head + "\"1.5\" = \"rock\"\n", {"c.toml:5", "the code '1.5' must be a whole number"});
  refused(head + "01 = \"rock\"\n", {"c.toml:5", "the code '01' must be written as", "1"});
  refused(head + "2 = \"rock\"\n", {"zones.tif", "zone '-1'", "codes are 0 and above", "nodata"});
  std::string many;
  for (int i = 0; i < 256; ++i) many += std::to_string(i) + " = \"zone " + std::to_string(i) + "\"\n";
  refused(head + many, {"c.toml", "[zone_names] has 256 zones", "at most 255"});
}

TEST_F(Campaigns, FaultsNameFileLineColumnAndValue) {
  refused("colour = 1\n", {"c.toml:3", "unknown key 'colour'"});
  refused("stops = \"none.csv\"\n", {"c.toml:3", "none.csv", "no such file"});
  refused("crs = \"EPSG:2056\"\n", {"c.toml", "EPSG:2056", "system of the DEM"});
  write_text("stops.csv", "id,x,y\nc,600052,5200010\n");
  refused("stops = \"stops.csv\"\n", {"stops.csv:2", "id = 'c'", "no block of"});
  write_text("passages.csv", "id,screen\na,S2\n");
  refused("passages = \"passages.csv\"\nscreens = \"screens.csv\"\n", {"passages.csv:2", "screen = 'S2'", "S1"});
  refused("passages = \"passages.csv\"\n", {"passages.csv:2", "screens = "});
}

/// No simulated block gets to a line off the DEM: rows there would score as the climatology, better than many a model.
TEST_F(Campaigns, AScreenThatWasCrossedMustLieOnTheDem) {
  write_text("screens.csv",
             "id,wkt\nS1,\"LINESTRING (600010 5200020, 600090 5200020)\"\nS2,\"LINESTRING (600010 "
             "5100020, 600090 5100020)\"\n");
  const std::string tables = "passages = \"passages.csv\"\nscreens = \"screens.csv\"\n";
  write_text("passages.csv", "id,screen\na,S1\n");
  EXPECT_TRUE(read(tables).campaign.blocks[0].passages[0].has_value());
  write_text("passages.csv", "id,screen\na,S1\na,S2\n");
  refused(tables, {"passages.csv:3", "screen = 'S2'", "is a line off the DEM"});
}

TEST_F(Campaigns, IdsOfScreensStayAsTheyStand) {
  write_text("screens.csv",
             "id,wkt\n01,\"LINESTRING (600010 5200020, 600090 5200020)\"\n1,\"LINESTRING (600010 5200030, 600090 "
             "5200030)\"\n");
  write_text("passages.csv", "id,screen\na,01\n");
  const LoadedCampaign loaded = read("passages = \"passages.csv\"\nscreens = \"screens.csv\"\n");
  ASSERT_EQ(loaded.campaign.screens.size(), 2U);
  EXPECT_EQ(loaded.campaign.screens[0].id, "01");
  EXPECT_EQ(loaded.campaign.screens[1].id, "1");
}

TEST_F(Campaigns, FaultsOfBlocks) {
  const std::string head = "id,x,y,release_height_m,mass_kg,L1_m,L2_m,L3_m\n", good = "a,600050,5200040,1,100,,,\n";
  const auto with = [&](const std::string& text) { write_text("blocks.csv", text); };
  with(head + good + "a,600050,5200040,1,100,,,\n");
  refused("", {"blocks.csv:3", "id = 'a'", "already in line 2"});
  with(head + "a,700050,5200040,1,100,,,\n");
  refused("", {"blocks.csv:2", "x = '700050'", "off the terrain"});
  with(head + "a,600050,5200040,1,100,0.5,0.9,0.2\n");
  refused("", {"blocks.csv:2", "L2_m = '0.9'", "L1_m = 0.5"});
  with(head + "a,600050,5200040,1,100,0.5,,\n");
  refused("", {"blocks.csv:2", "L2_m", "all three"});
  with(head + "a,600050,5200040,1,heavy,,,\n");
  refused("", {"blocks.csv:2", "mass_kg = 'heavy'", "number in kg"});
  with(head + "a,600050,5200040,1,\"1,5\",,,\n");
  refused("", {"blocks.csv:2", "mass_kg = '1,5'", "point for decimals"});
  with(head + "a,600050,5200040,1,-3,,,\n");
  refused("", {"blocks.csv:2", "mass_kg = '-3'", "above 0"});
  with(head + "a,600050,5200040,1,nan,,,\n");
  refused("", {"blocks.csv:2", "mass_kg = 'nan'"});
  with(head + "a,600050,5200040,1,,,,\n");
  refused("", {"blocks.csv:2", "mass_kg = ''", "must be given"});
  with(head + "a,600050,5200040,1\n");
  refused("", {"blocks.csv:2", "4 cells", "8"});
  with(head + good + "Stra\xDF,600050,5200040,1,100,,,\n");
  refused("", {"blocks.csv:3", "is not in UTF-8", "CSV UTF-8"});
  with(std::string("\xFF\xFEi\0d\0", 6));
  refused("", {"blocks.csv: is UTF-16, must be UTF-8"});
  with(head + good + std::string("b,600050\0", 9));
  refused("", {"blocks.csv:3: holds a zero byte (NUL)", "UTF-8"});
  with("id,x,y,release_height_m,mass\n");
  refused("", {"blocks.csv:1", "unknown column 'mass'", "mass_kg"});
  with("id,x,y,release_height_m,mass,Laenge,mass_kg\n");
  refused("", {"blocks.csv:1", "unknown columns: mass, Laenge", "mass_kg"});
  with("id,x,y,release_height_m\n");
  refused("", {"blocks.csv:1", "no column 'mass_kg'"});
  with(head);
  refused("", {"blocks.csv", "no blocks"});
  with("");
  refused("", {"blocks.csv", "empty"});
}

TEST_F(Campaigns, AModelReadsBackTheSame) {
  RasterFile zones;
  zones.type = GDT_Byte;
  zones.values.assign(80, 1.0);
  zones.write(path("zones.tif"));
  const LoadedCampaign loaded = read("zones = \"zones.tif\"\n[zone_names]\n1 = \"steep talus\"\n");
  Model model = model_of_preset(loaded.campaign, "upper-talus-3d");
  model.grounds[1] = {1.0 / 3.0, 0.123456789012345, 7.7, 1e-3, std::tan(radians(33.0)), 0.9, 1.25};
  model.grounds[0].En50 = 5.5;
  model.impact = {0.3, Roughness::Resample};
  const Model back =
      read_model(write_text("m.toml", model_text(model, loaded, "two lines\nof heading")), loaded.campaign);
  for (std::size_t z = 0; z < 2; ++z) {
    EXPECT_EQ(back.grounds[z].theta_scale, model.grounds[z].theta_scale);
    EXPECT_EQ(back.grounds[z].psi_scale, model.grounds[z].psi_scale);
    EXPECT_EQ(back.grounds[z].En50, model.grounds[z].En50);
    EXPECT_EQ(back.grounds[z].Et50, model.grounds[z].Et50);
    EXPECT_NEAR(back.grounds[z].tan_phi, model.grounds[z].tan_phi, 1e-15);
    EXPECT_EQ(back.grounds[z].shape_max, model.grounds[z].shape_max);
  }
  Model start = model;  // a zone that no block touched is no fitted one
  start.grounds[0] = model_of_preset(loaded.campaign, "upper-talus-3d").grounds[0];
  const std::string text_of_start = model_text(start, loaded, "");
  EXPECT_NE(text_of_start.find("[ground.zones.default]\npreset = \"upper-talus-3d\"\n# not fitted: as the preset\n\n["),
            std::string::npos)
      << text_of_start;
  EXPECT_EQ(read_model(write_text("s.toml", text_of_start), loaded.campaign).grounds[0].theta_scale,
            start.grounds[0].theta_scale);
  EXPECT_EQ(back.impact.deformation_coefficient, 0.3);
  EXPECT_EQ(back.impact.roughness, Roughness::Resample);
  const auto faulty = [&](const std::string& text, const std::vector<std::string>& parts) {
    write_text("m.toml", text);
    expect_input_error([&] { read_model(path("m.toml"), loaded.campaign); }, parts);
  };
  faulty("[ground.zones.tallus]\nEn50 = 3\n", {"m.toml", "tallus", "no such zone", "steep talus"});
  faulty("[ground.zones.\"steep talus\"]\nEn5 = 3\n", {"m.toml:2", "unknown key 'En5'", "En50"});
  faulty("dem = \"x\"\n", {"m.toml:1", "unknown key 'dem'"});
  faulty("[model]\nstop_speed = 1\n", {"m.toml:2", "unknown key 'stop_speed'"});
  faulty("[ground.zones.default]\nEn50 = -3\n", {"m.toml:2", "En50 = -3"});
}

TEST_F(Campaigns, ZonesThatAModelLeavesToTheDefaultAreSaid) {
  RasterFile zones;
  zones.type = GDT_Byte;
  zones.values.assign(80, 1.0);
  zones.write(path("zones.tif"));
  const LoadedCampaign loaded =
      read("zones = \"zones.tif\"\n[zone_names]\n1 = \"talus\"\n2 = \"meadow\"\n3 = \"rock\"\n");
  const auto warnings = [&](const std::string& text) {
    std::vector<std::string> said;
    read_model(write_text("m.toml", text), loaded.campaign, &said);
    return said;
  };
  EXPECT_TRUE(warnings("[ground]\ndefault = \"forest-road-3d\"\n").empty());
  EXPECT_TRUE(warnings("[ground.zones.default]\nEn50 = 3\n").empty());
  EXPECT_TRUE(
      warnings("[ground.zones.talus]\nEn50 = 3\n[ground.zones.meadow]\nEn50 = 3\n[ground.zones.rock]\nEn50 = 3\n")
          .empty());
  const std::vector<std::string> said =
      warnings("[ground]\ndefault = \"forest-road-3d\"\n[ground.zones.talus]\nEn50 = 3\n");
  ASSERT_EQ(said.size(), 1U);
  for (const char* part :
       {"m.toml: does not describe the zones meadow, rock", "default ground (forest-road-3d)", "[ground.zones.meadow]"})
    EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
}

TEST_F(Campaigns, AModelKeepsItsBarriersAndTheBiasOfItsInstruments) {
  write_text("passages.csv", "id,screen,speed_ms,jump_height_m,angular_velocity_rads\na,S1,12.5,,3\n");
  const LoadedCampaign loaded = read("passages = \"passages.csv\"\nscreens = \"screens.csv\"\n");
  Model model = model_of_preset(loaded.campaign, "upper-talus-3d");
  model.barriers = {{"undeclared \"wall\"", {{{-10.25, 30.0}, {120.0, 1.0 / 3.0}}}, 2.5, 1e300 * 1e300},
                    {"net", {{{1.0, 2.0}, {3.0, 4.0}}}, 3.0, 250e3}};
  model.bias.resize(2);
  model.bias[0].jump = 0.125;
  model.bias[1] = {-0.25, 0.0, 0.5};
  const std::string text = model_text(model, loaded, "");
  EXPECT_NE(text.find("from = [599989.75, 5200030]"), std::string::npos) << text;  // in the system of the DEM
  const Model back = read_model(write_text("m.toml", text), loaded.campaign);
  ASSERT_EQ(back.barriers.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.barriers[i].id, model.barriers[i].id);
    EXPECT_EQ(back.barriers[i].height, model.barriers[i].height);
    EXPECT_EQ(back.barriers[i].capacity, model.barriers[i].capacity);
    for (std::size_t end = 0; end < 2; ++end)
      EXPECT_LT((back.barriers[i].lines[0][end] - model.barriers[i].lines[0][end]).norm(), 1e-8);
  }
  ASSERT_EQ(back.bias.size(), 2U);
  EXPECT_EQ(back.bias[0].jump, 0.125);
  EXPECT_EQ(back.bias[1].speed, -0.25);
  EXPECT_EQ(back.bias[1].spin, 0.5);
  const auto faulty = [&](const std::string& lines, const std::vector<std::string>& parts) {
    write_text("m.toml", lines);
    expect_input_error([&] { read_model(path("m.toml"), loaded.campaign); }, parts);
  };
  faulty("[[instrument_bias]]\nscreen = \"S2\"\nspeed = 0.1\n", {"m.toml:1", "S2", "no such screen", "S1"});
  faulty("[[instrument_bias]]\nscreen = \"S1\"\nspeed = 0\n",
         {"m.toml:1", "does nothing, must give speed, jump or spin"});
  faulty("[[instrument_bias]]\nscreen = \"S1\"\nspeed = 0.5\n[[instrument_bias]]\nscreen = \"S1\"\njump = 0.1\n",
         {"m.toml:4", "of screen S1 is given twice"});
  faulty("[barriers]\nfile = \"n.gpkg\"\n", {"m.toml:2", "unknown key 'file'"});
  faulty("[barriers]\nline = []\n", {"m.toml:1", "[barriers] names no barrier, must have line"});
  faulty("[barriers]\nline = 3\n", {"m.toml:2", "barriers.line", "list of tables"});
  faulty("[[barriers.line]]\nheight = 2\nfrom = [1, 2]\n", {"m.toml:1", "has no to"});
  faulty("[[barriers.line]]\nheight = -2\nfrom = [1, 2]\nto = [3, 4]\n", {"m.toml:2", "height = -2", "0 to 100"});
  faulty("[[barriers.line]]\nheight = 2\nfrom = [1]\nto = [3, 4]\n", {"m.toml:3", "must be [x, y]"});
  faulty("[[barriers.line]]\nheight = 2\nfrom = [3, 4]\nto = [3, 4]\n", {"m.toml:4", "a barrier has a length"});
}

}  // namespace
}  // namespace talus::io::test
