#include <algorithm>
#include <cmath>
#include <tuple>

#include "scenario_files.hpp"

namespace talus::io::test {

TEST_F(ScenarioFile, EveryKeyArrives) {
  write_vector(path("zones.gpkg"), "EPSG:32632", {{"kind", OFTString}},
               {{"POLYGON((0 0,50 0,50 50,0 50,0 0))", {"road"}}});
  write_text("screens.csv", "id,wkt\nA,\"LINESTRING (600000 5200010, 600100 5200010)\"\n");
  const LoadedScenario l = load(R"(
dem = "dem.tif"
seed = 12345678901
trajectories = 7
[sources]
file = "sources.gpkg"
release_height = [0.5, 2.0]
[blocks]
diameter = [1.0, 1.4]
density = 2650.5
axes = [1.0, 0.8, 0.6]
[ground]
file = "zones.gpkg"
field = "kind"
default = "lower-talus-3d"
[ground.zones.road]
preset = "forest-road-3d"
theta_scale = 0.1
psi_scale = 0.2
En50 = 11
Et50 = 22
phi = 45
shape = [0.9, 1.1]
[model]
deformation_coefficient = 1
roughness = "resample"
stop_speed = 0.25
trap_time = 6
time_limit = 60
impact_limit = 1000
[output]
energy_thresholds = [30, 300, 500]
height_thresholds = [2.5]
trajectories = 0
[screens]
file = "screens.csv"
)");
  const Scenario& s = l.scenario;
  EXPECT_EQ(s.seed, 12345678901U);
  EXPECT_EQ(s.trajectories, 7U);
  EXPECT_EQ(s.features.at(0).release_height, (Range{0.5, 2.0}));
  ASSERT_EQ(s.blocks.classes.size(), 1U);
  EXPECT_EQ(s.blocks.classes[0].diameter, (Range{1.0, 1.4}));
  EXPECT_DOUBLE_EQ(s.blocks.density, 2650.5);
  EXPECT_EQ(s.blocks.axes, Vec3(1.0, 0.8, 0.6));
  ASSERT_EQ(s.cover.grounds.size(), 2U);
  EXPECT_DOUBLE_EQ(s.cover.grounds[0].theta_scale, 1.5);  // lower-talus-3d
  const Ground& road = s.cover.grounds[1];
  EXPECT_DOUBLE_EQ(road.theta_scale, 0.1);
  EXPECT_DOUBLE_EQ(road.psi_scale, 0.2);
  EXPECT_DOUBLE_EQ(road.En50, 11.0);
  EXPECT_DOUBLE_EQ(road.Et50, 22.0);
  EXPECT_NEAR(road.tan_phi, 1.0, 1e-15);  // tan 45 deg
  EXPECT_DOUBLE_EQ(road.shape_min, 0.9);
  EXPECT_DOUBLE_EQ(road.shape_max, 1.1);
  EXPECT_EQ(s.zone_names, (std::vector<std::string>{"default", "road"}));
  EXPECT_EQ(s.cover.zone_at(25.0, 25.0), 1);
  EXPECT_EQ(s.cover.zone_at(55.0, 25.0), 0);
  EXPECT_DOUBLE_EQ(s.impact.deformation_coefficient, 1.0);
  EXPECT_EQ(s.impact.roughness, Roughness::Resample);
  EXPECT_DOUBLE_EQ(s.rules.stop_speed, 0.25);
  EXPECT_DOUBLE_EQ(s.rules.trap_time, 6.0);
  EXPECT_DOUBLE_EQ(s.rules.time_limit, 60.0);
  EXPECT_EQ(s.rules.impact_limit, 1000U);
  EXPECT_EQ(s.output.energy_thresholds, (std::vector<double>{30, 300, 500}));
  EXPECT_EQ(s.output.height_thresholds, (std::vector<double>{2.5}));
  EXPECT_EQ(s.output.paths, 0U);
  ASSERT_EQ(s.screens.size(), 1U);
  EXPECT_EQ(s.screens[0].id, "A");
  EXPECT_EQ(l.inputs.size(), 5U);
  for (const InputFile& input : l.inputs) EXPECT_EQ(input.sha256.size(), 64U) << input.path;
}

TEST_F(ScenarioFile, DefaultsAndOrigins) {
  const LoadedScenario l = with("density = 2500\n[ground]\ndefault = \"forest-road-3d\"\n");
  EXPECT_EQ(l.scenario.seed, 1U);
  EXPECT_EQ(l.scenario.trajectories, 100U);
  EXPECT_TRUE(l.scenario.cover.zones.values.empty());
  EXPECT_EQ(origin(l, "blocks.density"), "scenario");
  EXPECT_EQ(origin(l, "seed"), "default");
  EXPECT_EQ(origin(l, "ground.default.En50"), "preset forest-road-3d");
  EXPECT_EQ(load(std::string(kFiles) + "[blocks]\ndiameter = 1\n").settings.size(), l.settings.size());
}

TEST_F(ScenarioFile, UnknownKeysAreNamedWithLineAndNearestKey) {
  refused(
      "dem = \"dem.tif\"\n[sources]\nfile = \"sources.gpkg\"\n[blocks]\ndiameter = 1\ndmesity = 2\n",
      {"scenario.toml:6: unknown key 'dmesity' in [blocks]; did you mean 'density'? (known: density, diameter, axes)"});
  refused(std::string("trajectory = 5\n") + kFiles,
          {"scenario.toml:1: unknown key 'trajectory' at the top; did you mean 'trajectories'?"});
  refused(std::string(kFiles) + "hight = 5\n", {"scenario.toml:4: unknown key 'hight' in [sources]"});
  refused(std::string(kFiles) + "[modle]\nstop_speed = 1\n",
          {"scenario.toml:4: unknown key 'modle' at the top; did you mean 'model'?"});
  refused(std::string(kFiles) + "[ground]\nfile=\"dem.tif\"\n[ground.zones.x]\npresets = \"a\"\n",
          {"scenario.toml:7: unknown key 'presets' in [ground.zones.x]; did you mean 'preset'?"});
  refused(std::string(kFiles) + "[blocks]\ndiameter = [{ diameter = 1, wieght = 2 }]\n",
          {"scenario.toml:5: unknown key 'wieght' in [blocks.diameter]; did you mean 'weight'?"});
}

TEST_F(ScenarioFile, WhatIsNotInThisVersionIsSaidByName) {
  refused(std::string(kFiles) + "[barriers]\nfile = \"n.gpkg\"\n", {"scenario.toml:5", "no such file", "n.gpkg"});
  refused(std::string(kFiles) + "[barriers]\nfiel = \"n.gpkg\"\n",
          {"scenario.toml:5: unknown key 'fiel' in [barriers]; did you mean 'file'?"});
  for (const char* empty : {"[barriers]\n", "[barriers]\nline = []\n"})
    refused(std::string(kFiles) + empty, {"scenario.toml:4: [barriers] names no barrier, must have file"});
  refused(std::string(kFiles) + "[effects.vegetation-drag]\nheight = 8\n",
          {"scenario.toml:4: [effects.vegetation-drag] does nothing, must give coefficient"});
  refused(std::string(kFiles) + "[effects.vegetation-darg]\nheight = 8\n",
          {"unknown key 'vegetation-darg' in [effects]; did you mean 'vegetation-drag'?"});
}

TEST_F(ScenarioFile, WrongTypesAndBounds) {
  const std::string files(kFiles);
  refused("seed = \"one\"\n" + files, {"scenario.toml:1: seed = 'one': must be a whole number"});
  refused("seed = 1.5\n" + files, {"seed = 1.5: must be a whole number, 0 to 9007199254740991"});
  refused("seed = -1\n" + files, {"seed = -1: must be a whole number"});
  refused("trajectories = 0\n" + files, {"trajectories = 0: must be a whole number, 1 to 1000000000"});
  refused("dem = 5\n[sources]\nfile = \"sources.gpkg\"\n", {"scenario.toml:1: dem = 5: must be text"});
  refused(files + "release_height = [1, 2, 3]\n",
          {"scenario.toml:4: sources.release_height = [1, 2, 3]: must be a number or [smallest, largest] in m"});
  refused(files + "release_height = [2, 1]\n", {"must be [smallest, largest]"});
  refused(files + "[blocks]\ndiameter = 51\n", {"blocks.diameter = 51: must be 0.01 to 50 m"});
  refused(files + "[blocks]\ndiameter = nan\n", {"blocks.diameter = nan: must be 0.01 to 50 m"});
  refused(files + "[blocks]\ndensity = 2.7\n", {"blocks.density = 2.7: must be 500 to 8000 kg/m3"});
  refused(files + "[blocks]\naxes = [0.6, 0.8, 1.0]\n",
          {"blocks.axes = [0.6, 0.8, 1]: must be three numbers, L1 >= L2 >= L3"});
  refused(files + "[model]\nroughness = \"round\"\n", {"model.roughness = 'round': must be 'clamp' or 'resample'"});
  refused(files + "[model]\ndeformation_coefficient = 0\n", {"must be above 0 and at most 100"});
  refused(files + "[output]\nenergy_thresholds = [30, 300, 300]\n",
          {"output.energy_thresholds = [30, 300, 300]: must be 1 to 32 numbers that ascend"});
  refused(files + "[output]\nheight_thresholds = [0, 1]\n", {"output.height_thresholds = 0: must be above 0"});
  refused(files + "[ground]\ndefault = \"talus-3d\"\n",
          {"ground.default = 'talus-3d': unknown preset 'talus-3d'", "upper-talus-3d"});
  refused(files + "[ground.zones.1]\n", {"[ground.zones] without file"});
  refused(files + "[blocks]\ndiameter = [{ diameter = 1, frequency = 1 }, { diameter = 2 }]\n",
          {"scenario.toml:5: blocks.diameter", "a frequency for 1 of 2 classes, must have it for all or none"});
  refused("sources = 5\ndem = \"dem.tif\"\n", {"sources = 5: must be a table, [sources]"});
}

TEST_F(ScenarioFile, AllFaultsAreListedAndTheFirstThrown) {
  RunFlags flags;
  flags.scenario =
      write_text("scenario.toml", "seed = -1\ndem = \"dem.tif\"\n[sources]\nfile = \"nothing.shp\"\nx = 1\n");
  std::vector<std::string> faults;
  expect_input_error([&] { load_scenario(flags, &faults); },
                     {"scenario.toml:1: seed", "(and 2 more faults: talus check lists all)"});
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_NE(faults[1].find("scenario.toml:5: unknown key 'x'"), std::string::npos);
  EXPECT_NE(faults[2].find("scenario.toml:4: sources.file = 'nothing.shp': no such file"), std::string::npos);
}

TEST_F(ScenarioFile, WhatIsNoTomlIsRefusedWithItsLine) {
  refused("dem = \"dem.tif\"\nseed = = 1\n", {"scenario.toml:2: is no valid TOML"});
  refused("seed = 1\nseed = 2\n", {"scenario.toml:2: is no valid TOML"});
  RunFlags flags;
  flags.scenario = path("");
  expect_input_error([&] { load_scenario(flags); }, {"cannot be read"});
  flags.scenario = path("nothing.toml");
  expect_input_error([&] { load_scenario(flags); }, {"nothing.toml: no such file (", "it must be a TOML file"});
}

TEST_F(ScenarioFile, MissingPartsAreSaid) {
  refused("", {"no terrain", "--dem", "(and 1 more fault"});
  refused("dem = \"dem.tif\"\n", {"no sources", "[sources] file", "--sources"});
  refused(std::string(kFiles), {"sources.gpkg: feature 1 has no block diameter", "[blocks] diameter", "--diameter",
                                "diameter_min", "its fields: "});
}

TEST_F(ScenarioFile, DiameterOfTheFeatureThenTheFlagThenTheScenario) {
  write_vector(path("sources.gpkg"), "EPSG:32632", {{"diameter", OFTReal}},
               {{"POINT(55 45)", {"0.5"}}, {"POINT(55 45)", {"NULL"}}});
  RunFlags flags;
  flags.diameter = 3.0;
  const LoadedScenario l =
      load(std::string(kFiles) + "[blocks]\ndiameter = { volume_min = 0.1, volume_max = 2, exponent = 1.2 }\n", flags);
  EXPECT_EQ(l.scenario.features[0].diameter, (Range{0.5, 0.5}));
  EXPECT_TRUE(std::isnan(l.scenario.features[1].diameter.low));
  ASSERT_EQ(l.scenario.blocks.classes.size(), 1U);
  EXPECT_EQ(l.scenario.blocks.classes[0].diameter, (Range{3.0, 3.0}));
  EXPECT_EQ(l.scenario.blocks.power_law.volume.high, 0.0);
  EXPECT_EQ(origin(l, "blocks.diameter"), "flag --diameter");
  EXPECT_EQ(origin(l, "sources.attributes.diameter"), "attribute diameter of sources.gpkg");
}

/// A sphere of 1 m has pi/6 m3, one of 2 m eight times as much.
TEST_F(ScenarioFile, ClassesByVolume) {
  const auto classes = [&](const std::string& text) {
    return load(std::string(kFiles) + "[blocks]\ndiameter = [" + text + "]\n").scenario.blocks.classes;
  };
  const auto found = classes("{ volume = [0.5235987755982988, 4.188790204786391], weight = 3 }, { diameter = 0.5 }");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].diameter.low, 1.0, 1e-15);
  EXPECT_NEAR(found[0].diameter.high, 2.0, 1e-15);
  EXPECT_EQ(found[0].weight, 3.0);
  expect_input_error([&] { classes("{ diameter = 1, volume = 1 }"); }, {"has a diameter and a volume, must have one"});
  expect_input_error([&] { classes("{ weight = 1 }"); }, {"has no diameter and no volume, must have one"});
  expect_input_error([&] { classes("{ volume = 70000 }"); }, {"volume = 70000: must be 1e-06 to 65000 m3"});
}

TEST_F(ScenarioFile, FlagsAlone) {
  RunFlags flags;
  flags.dem = path("dem.tif");
  flags.sources = path("sources.gpkg");
  flags.preset = "quarry-face-2d";
  flags.diameter = 1.5;
  flags.trajectories = 9;
  flags.seed = 77;
  const LoadedScenario l = load_scenario(flags);
  EXPECT_EQ(l.scenario.trajectories, 9U);
  EXPECT_EQ(l.scenario.seed, 77U);
  EXPECT_DOUBLE_EQ(l.scenario.cover.grounds[0].En50, 5.0);
  EXPECT_DOUBLE_EQ(l.scenario.cover.grounds[0].psi_scale, 0.0);
  EXPECT_EQ(origin(l, "dem"), "flag --dem");
  EXPECT_EQ(origin(l, "ground.default"), "flag --preset");
  flags.preset = "quarry";
  expect_input_error([&] { load_scenario(flags); }, {"flag --preset = 'quarry'", "quarry-face-2d"});
  flags.preset.reset();
  flags.diameter = -1;
  expect_input_error([&] { load_scenario(flags); }, {"flag --diameter = -1: must be 0.01 to 50 m"});
}

TEST_F(ScenarioFile, FlagsWinOverTheScenario) {
  RunFlags flags;
  flags.preset = "forest-road-3d";
  flags.seed = 5;
  const LoadedScenario l = load(
      std::string("seed = 4\n") + kFiles + "[blocks]\ndiameter = 1\n[ground]\ndefault = \"lower-talus-3d\"\n", flags);
  EXPECT_DOUBLE_EQ(l.scenario.cover.grounds[0].theta_scale, 0.4);
  EXPECT_EQ(l.scenario.seed, 5U);
}

TEST_F(ScenarioFile, TheRecordHasNamesAsTheyAre) {
  for (const std::string name : {"say \"dem\".tif", "a\\b.tif", "line\nend\x01.tif"}) {
    RunFlags flags;
    flags.dem = RasterFile{}.write(path(name));
    const LoadedScenario l = load(std::string(kFiles) + "[blocks]\ndiameter = 1.2\n", flags);
    const auto dem = std::ranges::find(l.settings, "dem", &Setting::key);
    ASSERT_NE(dem, l.settings.end());
    EXPECT_EQ(dem->value, path(name));
  }
}

/// The map: 10 x 8 cells of 10 m, counts by hand. What is said of zones is said of the polygons of an effect.
TEST_F(ScenarioFile, PolygonsThatActNowhereAreNamed) {
  const std::string zone = "lower-talus-3d";
  write_vector(path("p.gpkg"), "EPSG:32632", {{"zone", OFTString}},
               {{"POLYGON((0 0,30 0,30 10,0 10,0 0))", {zone}},
                {"POLYGON((900 0,930 0,930 10,900 10,900 0))", {zone}},  // off the map
                {"POLYGON((0 41,90 41,90 44,0 44,0 41))", {zone}},       // between the centres of two rows
                {"", {zone}}});
  const LoadedScenario zones = with("[ground]\nfile = \"p.gpkg\"\n");
  const LoadedScenario effect = with("[effects.vegetation-drag]\nfile = \"p.gpkg\"\ncoefficient = 400\n");
  const std::string drag = "polygons of [effects.vegetation-drag]";
  for (const auto& [loaded, kind, name] :
       {std::tuple{&zones, std::string("zones"), " (" + zone + ")"}, {&effect, drag, std::string()}}) {
    const std::vector<std::string>& warnings = loaded->warnings;
    EXPECT_TRUE(said(warnings, "p.gpkg: " + kind + " wholly off the DEM, which have no effect: FID 2" + name));
    EXPECT_TRUE(said(warnings, "p.gpkg: " + kind +
                                   " that cover no cell of the DEM (its centre counts) and have no effect: " + "FID 3" +
                                   name + ": draw them wider than a cell, 10 m"));
    EXPECT_TRUE(said(warnings, "p.gpkg: " + kind + " without geometry, which have no effect: FID 4" + name));
  }
  EXPECT_TRUE(said(effect.notes, "vegetation-drag acts in 3 of 80 cells (0.03 ha): coefficient = 400 kg/s"));
  EXPECT_FALSE(said(effect.warnings, "acts nowhere"));
  write_vector(path("q.gpkg"), "EPSG:32632", {}, {{"POLYGON((0 41,90 41,90 44,0 44,0 41))"}});
  EXPECT_TRUE(said(with("[effects.vegetation-drag]\nfile = \"q.gpkg\"\ncoefficient = 400\n").warnings, "acts nowhere"));
}

}  // namespace talus::io::test
