#include <cmath>
#include <tuple>

#include "scenario_files.hpp"

namespace talus::io::test {

TEST_F(ScenarioFile, AnIncludedModelComesFirstAndTheScenarioWins) {
  RasterFile zones;
  zones.type = GDT_Byte;
  zones.values.assign(80, 3.0);
  zones.write(path("zones.tif"));
  write_text("fitted.toml", R"(
[ground.zones.default]
En50 = 7
[ground.zones.talus]
code = 3
theta_scale = 0.6
En50 = 9
[ground.zones.meadow]
preset = "forest-road-3d"
[model]
deformation_coefficient = 0.5
)");
  const std::string head = std::string("include = \"fitted.toml\"\n") + kFiles + "[blocks]\ndiameter = 1.2\n";
  const LoadedScenario l = load(head + "[ground]\nfile = \"zones.tif\"\n[ground.zones.talus]\nEn50 = 11\n");
  ASSERT_EQ(l.scenario.zone_names, (std::vector<std::string>{"default", "talus", "meadow"}));
  EXPECT_EQ(l.scenario.cover.grounds[0].En50, 7.0);
  EXPECT_EQ(l.scenario.cover.grounds[1].theta_scale, 0.6);
  EXPECT_EQ(l.scenario.cover.grounds[1].En50, 11.0);
  EXPECT_EQ(l.scenario.cover.grounds[2].theta_scale, 0.4);
  EXPECT_EQ(l.scenario.cover.zones.at(5, 5), 1);  // the code 3 of the raster is the talus
  EXPECT_EQ(l.scenario.impact.deformation_coefficient, 0.5);
  EXPECT_EQ(origin(l, "ground.zones.talus.En50"), "scenario");
  EXPECT_EQ(origin(l, "ground.zones.talus.theta_scale"), "include fitted.toml");
  EXPECT_EQ(origin(l, "model.deformation_coefficient"), "include fitted.toml");
  ASSERT_EQ(l.inputs[1].role, "include");
  EXPECT_EQ(l.inputs[1].path, path("fitted.toml"));
  EXPECT_EQ(l.inputs[1].sha256.size(), 64U);

  const LoadedScenario again = load(l.complete_toml);  // needs no include
  for (std::size_t z = 0; z < 3; ++z) {
    EXPECT_EQ(again.scenario.cover.grounds[z].En50, l.scenario.cover.grounds[z].En50);
    EXPECT_EQ(again.scenario.cover.grounds[z].theta_scale, l.scenario.cover.grounds[z].theta_scale);
  }
  EXPECT_EQ(again.scenario.cover.zones.values, l.scenario.cover.zones.values);
  EXPECT_EQ(again.complete_toml, l.complete_toml);

  const LoadedScenario preset =
      load(head + "[ground]\nfile = \"zones.tif\"\n[ground.zones.talus]\npreset = \"lower-talus-3d\"\n");
  EXPECT_EQ(preset.scenario.cover.grounds[1].theta_scale, 1.5);  // a preset starts the zone anew
}

TEST_F(ScenarioFile, TheDefaultGroundHasACodeOfItsOwn) {
  RasterFile zones;
  zones.type = GDT_Byte;
  zones.values.assign(80, 0.0);
  zones.values[0] = 2.0;  // the north-western cell
  zones.write(path("zones.tif"));
  const LoadedScenario l = load(std::string(kFiles) + "[blocks]\ndiameter = 1.2\n[ground]\nfile = \"zones.tif\"\n" +
                                "[ground.zones.default]\ncode = 0\n[ground.zones.2]\npreset = \"forest-road-3d\"\n");
  const auto& cells = l.scenario.cover.zones.values;
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), 1);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 0), 79);
  const LoadedScenario again = load(l.complete_toml);  // the complete scenario of a run can be run again
  EXPECT_EQ(again.scenario.cover.zones.values, cells);
  EXPECT_EQ(again.complete_toml, l.complete_toml);
}

/// The numbers of a ground; those of presets are of Table 3 of the paper.
struct Numbers {
  double theta_scale, En50, phi;  // [-], [m3/s2], [deg]
  void expect_of(const LoadedScenario& l) const {
    const Ground& ground = l.scenario.cover.grounds[0];
    EXPECT_EQ(ground.theta_scale, theta_scale);
    EXPECT_EQ(ground.En50, En50);
    EXPECT_NEAR(ground.tan_phi, std::tan(phi * std::acos(-1.0) / 180.0), 1e-12);
  }
};

TEST_F(ScenarioFile, APresetOfTheCommandLineReplacesTheDefaultGroundOfAnInclude) {
  const std::string every =
      "[ground.zones.default]\npreset = \"upper-talus-3d\"\ntheta_scale = 1.7\npsi_scale = 0.9\nEn50 = 22\nEt50 = 50\n"
      "phi = 33\nshape = [1, 1.5]\n";
  write_text("fitted.toml", every);
  const Numbers fitted{1.7, 22.0, 33.0}, lower{1.5, 15.0, 30.0}, road{0.4, 15.0, 30.0};
  const std::string alone = std::string("include = \"fitted.toml\"\n") + kFiles + "[blocks]\ndiameter = 1.2\n";
  const std::string with_default = alone + "[ground]\ndefault = \"lower-talus-3d\"\n";
  RunFlags to_lower, to_road;
  to_lower.preset = "lower-talus-3d";
  to_road.preset = "forest-road-3d";
  fitted.expect_of(load(alone));
  lower.expect_of(load(with_default));
  for (const auto& [text, flags, numbers] :
       {std::tuple{alone, to_lower, lower}, std::tuple{with_default, to_road, road}}) {
    const LoadedScenario l = load(text, flags);
    numbers.expect_of(l);
    EXPECT_EQ(origin(l, "ground.default"), "flag --preset");
    EXPECT_EQ(origin(l, "ground.default.En50"), "preset " + *flags.preset);
    EXPECT_FALSE(said(l.warnings, "changes nothing"));
    EXPECT_TRUE(said(l.warnings, "fitted.toml, with its En50, Et50, phi"));
    numbers.expect_of(load(l.complete_toml));
  }
  // numbers of the scenario itself count more than the flag
  const std::string own = std::string(kFiles) + "[blocks]\ndiameter = 1.2\n";
  const LoadedScenario hidden = load(own + every, to_lower);
  fitted.expect_of(hidden);
  EXPECT_TRUE(said(hidden.warnings, "flag --preset = 'lower-talus-3d' changes nothing"));
  const LoadedScenario one = load(own + "[ground.zones.default]\nEn50 = 22\n", to_lower);
  Numbers{lower.theta_scale, 22.0, lower.phi}.expect_of(one);
  EXPECT_FALSE(said(one.warnings, "changes nothing"));
}

TEST_F(ScenarioFile, AnIncludedEffectGivesWayToTheScenario) {
  RasterFile zones;
  zones.type = GDT_Byte;
  zones.values.assign(80, 1.0);
  zones.write(path("zones.tif"));
  write_text("fitted.toml", "[effects.soft-ground]\nzones = [\"1\"]\ndrag = 2\n");
  const LoadedScenario l = load(
      "include = \"fitted.toml\"\n" + std::string(kFiles) + "[blocks]\ndiameter = 1.2\n[ground]\nfile = " +
      "\"zones.tif\"\n[ground.zones.1]\npreset = \"forest-road-3d\"\n[effects.soft-ground]\nzones = [\"default\"]\n");
  const talus::EffectArea& where = l.scenario.effects.soft_ground.where;
  EXPECT_TRUE(where.covers(0, 1.0, 1.0));
  EXPECT_FALSE(where.covers(1, 1.0, 1.0));
  EXPECT_EQ(l.scenario.effects.soft_ground.drag, 2.0);
  EXPECT_EQ(origin(l, "effects.soft-ground.drag"), "include fitted.toml");
  EXPECT_EQ(origin(l, "effects.soft-ground.zones"), "scenario");
}

/// A barrier that `talus diagnose` found becomes one of the scenario; errors of instruments do not.
TEST_F(ScenarioFile, AnIncludedModelBringsItsBarriers) {
  write_text("found.toml",
             "[barriers]\nline = [{ id = \"undeclared-barrier\", height = 2.5, from = [600010, 5200020], to = "
             "[600090, 5200030] }]\n[[instrument_bias]]\nspeed = 0.2\n");
  const std::string head = std::string("include = \"found.toml\"\n") + kFiles + "[blocks]\ndiameter = 1.2\n";
  const LoadedScenario l = load(head);
  ASSERT_EQ(l.scenario.barriers.list().size(), 1U);
  const Barrier& barrier = l.scenario.barriers.list()[0];
  EXPECT_EQ(barrier.id, "undeclared-barrier");
  EXPECT_EQ(barrier.height, 2.5);
  EXPECT_TRUE(std::isinf(barrier.capacity));
  EXPECT_EQ(barrier.lines[0][0], Eigen::Vector2d(10.0, 20.0));
  EXPECT_EQ(barrier.lines[0][1], Eigen::Vector2d(90.0, 30.0));
  EXPECT_EQ(origin(l, "barriers.line"), "include found.toml");
  EXPECT_TRUE(std::any_of(l.warnings.begin(), l.warnings.end(), [](const std::string& line) {
    return line.find("found.toml") != std::string::npos &&
           line.find("[[instrument_bias]] is left out") != std::string::npos;
  }));
  const LoadedScenario again = load(l.complete_toml);
  ASSERT_EQ(again.scenario.barriers.list().size(), 1U);
  EXPECT_EQ(again.scenario.barriers.list()[0].lines, barrier.lines);
  EXPECT_EQ(again.complete_toml, l.complete_toml);
  const LoadedScenario own =
      load(head + "[[barriers.line]]\nheight = 4\ncapacity = 100\nfrom = [600010, 5200020]\nto = [600020, 5200020]\n");
  ASSERT_EQ(own.scenario.barriers.list().size(), 1U);
  EXPECT_EQ(own.scenario.barriers.list()[0].capacity, 100e3);
  refused(std::string(kFiles) + "[[instrument_bias]]\nspeed = 0.2\n", {"unknown key 'instrument_bias'"});
}

/// In barriers.csv and the summary they would have one name.
TEST_F(ScenarioFile, BarriersOfOneIdAreSaid) {
  write_vector(path("nets.gpkg"), "EPSG:32632", {{"id", OFTString}, {"height", OFTReal}, {"capacity", OFTReal}},
               {{"LINESTRING(10 20,30 40)", {"n", "4", "100"}},
                {"LINESTRING(10 30,30 50)", {"n", "4", "100"}},
                {"LINESTRING(10 60,30 60)", {"upper", "4", "100"}}});
  const auto line = [](const std::string& id) {
    return "[[barriers.line]]\nid = \"" + id + "\"\nheight = 4\nfrom = [600010, 5200020]\nto = [600020, 5200020]\n";
  };
  const auto said = [](const LoadedScenario& l) {
    std::vector<std::string> lines;
    for (const std::string& warning : l.warnings)
      if (warning.find("the same id") != std::string::npos) lines.push_back(warning);
    return lines;
  };
  const std::string layer = "[barriers]\nfile = \"nets.gpkg\"\n";
  const std::vector<std::string> both = said(with(layer + line("upper") + line("lower")));
  ASSERT_EQ(both.size(), 1U);
  EXPECT_NE(both[0].find(": n, upper; give each an id of its own"), std::string::npos) << both[0];
  EXPECT_EQ(said(with(line("n") + line("n"))).size(), 1U);
  EXPECT_TRUE(said(with(line("n") + line("m"))).empty());
}

TEST_F(ScenarioFile, FaultsOfAnInclude) {
  const std::string head = std::string("include = \"fitted.toml\"\n") + kFiles + "[blocks]\ndiameter = 1.2\n";
  refused(head, {"scenario.toml:1", "include = 'fitted.toml'", "no such file"});
  write_text("fitted.toml", "[ground.zones.talus]\nEn50 = 9\n");
  refused(head, {"include = 'fitted.toml'", "describes zones", "[ground]"});
  write_text("fitted.toml", "dem = \"x\"\n");
  refused(head, {"fitted.toml:1", "unknown key 'dem'"});
  write_text("fitted.toml", "[ground.zones.default]\nEn50 = 9\n");
  EXPECT_EQ(load(head).scenario.cover.grounds[0].En50, 9.0);
}

}  // namespace talus::io::test
