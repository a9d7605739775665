#include "talus/simulate/scenario/scenario.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "talus/base/error.hpp"

namespace talus {

// The smallest valid scenario: 4 x 3 cells, one source, one size of block.
Scenario small() {
  Scenario s;
  s.surface = Surface(Raster<float>(Grid{4, 3, 2.0, 2.0, 0.0, 0.0}, 100.0F));
  s.cover.grounds = {Ground{}};
  s.zone_names = {"default"};
  s.features = {SourceFeature{}};
  s.sources = {SourceCell{0, 3.0, 3.0, false}};
  s.blocks.classes = {BlockClass{{1.0, 1.0}}};
  return s;
}

void refused(const std::function<void(Scenario&)>& change, const std::string& part) {
  Scenario s = small();
  change(s);
  try {
    make_scenario(std::move(s));
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << "'" << part << "' is not in: " << error.what();
    return;
  }
  FAIL() << "taken: " << part;
}

TEST(MakeScenario, TakesWhatIsValid) {
  EXPECT_EQ(make_scenario(small()).sources.size(), 1U);
  Scenario s = small();
  s.blocks.classes.clear();
  s.features[0].diameter = {0.5, 1.5};
  s.surface = Surface(Raster<float>(Grid{4, 3, 2.0, 2.0, 0.0, 0.0},
                                    std::numeric_limits<float>::quiet_NaN()));  // no terrain under it: `left`
  EXPECT_NO_THROW(make_scenario(s));
  s = small();
  s.blocks.classes.clear();
  s.blocks.power_law = {{0.1, 2.0}, 1.0};
  EXPECT_NO_THROW(make_scenario(s));
}

TEST(MakeScenario, RefusesPartsThatDoNotFit) {
  refused([](Scenario& s) { s.sources.clear(); }, "no place of release");
  refused([](Scenario& s) { s.sources[0].feature = 1; }, "belongs to feature 1");
  refused([](Scenario& s) { s.sources[0].x = 9.0; }, "lies off the terrain");
  refused([](Scenario& s) { s.sources[0].y = kNotGiven; }, "lies off the terrain");
  refused(
      [](Scenario& s) {
        s.cover.zones = Raster<std::uint8_t>(Grid{4, 3, 1.0, 2.0, 0.0, 0.0}, 0);
      },
      "not on the grid of the DEM");
  refused(
      [](Scenario& s) {
        s.cover.zones = Raster<std::uint8_t>(Grid{4, 3, 2.0, 2.0, 0.0, 0.0}, 1);
      },
      "zone number 1 has no parameters");
  refused([](Scenario& s) { s.cover.grounds.clear(); }, "0 kinds of ground");
  refused([](Scenario& s) { s.zone_names.clear(); }, "0 names of zones for 1");
  refused([](Scenario& s) { s.surface = Surface(Raster<float>(Grid{4, 1, 2.0, 2.0, 0.0, 0.0}, 1.0F)); }, "4 x 1 cells");
  refused([](Scenario& s) { s.screens = {Screen{"A", {{Eigen::Vector2d(1, 1)}}}}; }, "screens: 'A'");
}

TEST(MakeScenario, RefusesNumbersOutOfBounds) {
  refused([](Scenario& s) { s.trajectories = 0; }, "trajectories = 0: must be a whole number, 1 to 1000000000");
  refused([](Scenario& s) { s.blocks.density = 10.0; }, "blocks.density = 10: must be 500 to 8000 kg/m3");
  refused([](Scenario& s) { s.blocks.density = kNotGiven; }, "blocks.density = nan");
  refused([](Scenario& s) { s.cover.grounds[0].En50 = 0.0; }, "ground.default.En50 = 0: must be above 0");
  refused([](Scenario& s) { s.cover.grounds[0].shape_min = 1.2; }, "ground.default.shape = [1.2, 1]");
  refused([](Scenario& s) { s.cover.grounds[0].tan_phi = -0.1; }, "ground.default.phi = -5.7");
  refused([](Scenario& s) { s.impact.deformation_coefficient = 0.0; }, "model.deformation_coefficient = 0");
  refused([](Scenario& s) { s.features[0].release_height = {2.0, 1.0}; }, "release_height = [2, 1]");
  refused([](Scenario& s) { s.features[0].velocity.z() = 300.0; }, "vz = 300");
  refused([](Scenario& s) { s.features[0].frequency = -1.0; }, "frequency = -1");
}

TEST(MakeScenario, RefusesBlocksThatMakeNoSense) {
  refused([](Scenario& s) { s.blocks.classes.clear(); }, "has no diameter");
  refused([](Scenario& s) { s.blocks.classes[0].diameter = {2.0, 1.0}; }, "blocks.diameter = [2, 1]");
  refused([](Scenario& s) { s.blocks.classes[0].weight = 0.0; }, "weight = 0");
  refused([](Scenario& s) { s.blocks.classes.push_back({{1.0, 1.0}, 1.0, 0.5}); }, "1 of 2 classes have a frequency");
  refused([](Scenario& s) { s.blocks.power_law = {{0.1, 2.0}, 1.0}; }, "classes and a power law");
  refused([](Scenario& s) { s.blocks.classes.clear(), s.blocks.power_law = {{3.0, 2.0}, 1.0}; }, "volume_min = 3");
  refused(
      [](Scenario& s) {
        s.blocks.classes.clear(), s.blocks.power_law = {{0.1, 2.0}, 1e-15};
      },
      "blocks.diameter.exponent = 1e-15: must be 1e-06 to 10");
  refused([](Scenario& s) { s.blocks.axes = Vec3(1.0, 1.1, 0.5); }, "must be L1 >= L2 >= L3");
  refused([](Scenario& s) { s.blocks.axes = Vec3(1000.0, 1.0, 1e-306); },
          "blocks.axes = 1e-306: must be 0.001 to 1000");
}

TEST(MakeScenario, ThresholdsAscend) {
  refused([](Scenario& s) { s.output.energy_thresholds = {30.0, 30.0}; }, "30 follows 30, must ascend");
  refused([](Scenario& s) { s.output.height_thresholds = {2.0, 1.0}; }, "1 follows 2, must ascend");
  refused([](Scenario& s) { s.output.height_thresholds = {-1.0}; }, "must be above 0");
  refused([](Scenario& s) { s.output.height_thresholds = {}; }, "1 to 32");
}

}  // namespace talus
