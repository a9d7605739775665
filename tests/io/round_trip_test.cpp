#include <cmath>

#include "files.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io::test {

// Loads a scenario, writes its complete form elsewhere, and loads that: nothing may differ by a bit.
class RoundTrip : public Files {
 protected:
  RoundTrip() {
    RasterFile{}.write(path("dem.tif"));
    std::filesystem::create_directories(path("other"));
    write_vector(path("sources.gpkg"), "EPSG:32632", {{"diameter", OFTReal}, {"frequency", OFTReal}},
                 {{"POLYGON((0 0,50 0,50 50,0 50,0 0))", {"0.3", "0.1"}}});
    write_vector(path("zones \"a\".gpkg"), "EPSG:32632", {{"zone", OFTString}},
                 {{"POLYGON((0 0,50 0,50 50,0 50,0 0))", {"b c"}},
                  {"POLYGON((50 0,90 0,90 50,50 50,50 0))", {"10"}},
                  {"POLYGON((0 60,90 60,90 80,0 80,0 60))", {"é.\\"}}});
  }

  void check(const std::string& blocks, const std::string& rest) {
    RunFlags flags;
    flags.scenario =
        write_text("scenario.toml",
                   "dem = \"dem.tif\"\n" + rest.substr(0, rest.find("\n[") + 1) +
                       "[sources]\nfile = \"sources.gpkg\"\nrelease_height = [0.1, 0.30000000000000004]\n[blocks]\n" +
                       blocks + rest.substr(rest.find("\n[") + 1));
    const LoadedScenario a = load_scenario(flags);
    flags.scenario = write_text("other/scenario.toml", a.complete_toml);
    const LoadedScenario b = load_scenario(flags);
    EXPECT_EQ(a.complete_toml, b.complete_toml);
    same(a.scenario, b.scenario);
  }

  static void same(double a, double b) { EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << ' ' << b; }

  static void same(const Scenario& a, const Scenario& b) {
    for (const auto& field : scenario_fields()) same(field.get(a), field.get(b));
    EXPECT_EQ(a.zone_names, b.zone_names);
    ASSERT_EQ(a.cover.grounds.size(), b.cover.grounds.size());
    for (std::size_t i = 0; i < a.cover.grounds.size(); ++i) {
      const Ground &g = a.cover.grounds[i], &h = b.cover.grounds[i];
      EXPECT_EQ(std::tie(g.theta_scale, g.psi_scale, g.En50, g.Et50, g.tan_phi, g.shape_min, g.shape_max),
                std::tie(h.theta_scale, h.psi_scale, h.En50, h.Et50, h.tan_phi, h.shape_min, h.shape_max));
    }
    EXPECT_EQ(a.cover.zones.values, b.cover.zones.values);
    ASSERT_EQ(a.blocks.classes.size(), b.blocks.classes.size());
    for (std::size_t i = 0; i < a.blocks.classes.size(); ++i) {
      EXPECT_EQ(a.blocks.classes[i].diameter, b.blocks.classes[i].diameter);
      same(a.blocks.classes[i].weight, b.blocks.classes[i].weight);
      same(a.blocks.classes[i].frequency, b.blocks.classes[i].frequency);
    }
    EXPECT_EQ(a.blocks.power_law.volume, b.blocks.power_law.volume);
    same(a.blocks.power_law.exponent, b.blocks.power_law.exponent);
    EXPECT_EQ(a.blocks.axes, b.blocks.axes);
    EXPECT_EQ(a.impact.roughness, b.impact.roughness);
    EXPECT_EQ(a.output.energy_thresholds, b.output.energy_thresholds);
    EXPECT_EQ(a.output.height_thresholds, b.output.height_thresholds);
    EXPECT_EQ(a.frequency.by_true_area, b.frequency.by_true_area);
    same(a.frequency.per_area, b.frequency.per_area);
    same(a.frequency.scale, b.frequency.scale);
    same(a.frequency.exponent, b.frequency.exponent);
    ASSERT_EQ(a.sources.size(), b.sources.size());
    EXPECT_EQ(a.features.at(0).release_height, b.features.at(0).release_height);
  }
};

TEST_F(RoundTrip, OfDefaults) {
  check("", "\n");
}

TEST_F(RoundTrip, OfOddNumbers) {
  check(
      "density = 2700.0000000000005\naxes = [1, 0.1, 0.0010000000000000002]\n",
      "seed = 9007199254740991\ntrajectories = 1000000000\n[model]\nstop_speed = 1e-5\ntrap_time = "
      "0.3333333333333333\nroughness = \"resample\"\nimpact_limit = 100000\n"
      "[output]\nenergy_thresholds = [0.0123456789012345, 0.1, 1e9]\nheight_thresholds = [0.1]\ntrajectories = 1e6\n");
}

TEST_F(RoundTrip, OfDiameters) {
  check("diameter = 0.1\n", "\n");
  check("diameter = [0.1, 0.7]\n", "\n");
  check("diameter = { volume_min = 0.1, volume_max = 12.3, exponent = 0.7 }\n", "\n");
  check("diameter = [{ diameter = 0.1, weight = 3 }, { diameter = [1, 2.1] }]\n", "\n");
  check("diameter = [{ diameter = 0.1, weight = 3 }]\n", "\n");
}

TEST_F(RoundTrip, OfFrequencies) {
  std::filesystem::remove(path("sources.gpkg"));
  write_vector(path("sources.gpkg"), "EPSG:32632", {}, {{"POLYGON((0 0,50 0,50 50,0 50,0 0))"}});
  check("diameter = [{ diameter = 0.1, weight = 3, frequency = 0.1 }, { diameter = [1, 2.1], frequency = 0 }]\n", "\n");
  check("diameter = 0.1\n", "\n[frequency]\nby_true_area = true\nper_area = 0.00010000000000000005\n");
  check("diameter = { volume_min = 0.1, volume_max = 12.3, exponent = 0.7 }\n",
        "\n[frequency]\npower_law = { A = 0.30000000000000004, b = 0.7 }\n");
}

TEST_F(RoundTrip, OfZonesWithTheirNamesAndOrder) {
  check("",
        "\n[ground]\nfile = 'zones \"a\".gpkg'\ndefault = \"lower-talus-3d\"\n[ground.zones.'b c']\npreset = "
        "\"forest-road-3d\"\nphi = 33.3\n"
        "[ground.zones.10]\nphi = 88.99\nshape = [0.3, 0.3]\n[ground.zones.'é.\\']\nEn50 = 0.1\n");
}

}  // namespace talus::io::test
