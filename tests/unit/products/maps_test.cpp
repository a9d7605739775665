#include "talus/products/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "support/maps.hpp"
#include "support/scenarios.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::path_of;
using test::stay;

constexpr int kColumns = 6, kRows = 4;

/// Two source cells of 10 trajectories on a terrain of 6 x 4 cells; there is none at (5, 3).
Scenario small() {
  Scenario s =
      test::scenario_on(test::terrain(test::grid_of(kColumns, kRows, 1.0, 1.0), [](double, double) { return 0.0; }));
  Raster<float> heights = s.surface.heights();
  heights.at(5, 3) = std::numeric_limits<float>::quiet_NaN();
  s.surface = Surface(heights);
  s.sources.assign(2, {0, 1.5, 1.5, false});
  s.trajectories = 10;
  s.output.energy_thresholds = {10.0, 50.0};
  s.output.height_thresholds = {1.5};
  return s;
}

/// By hand, 1000 kg: source 0 sends 3 through (1, 1), one of them on to (2, 1); source 1 sends 2 through (2, 1).
Tally by_hand(const Scenario& s) {
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  VisitBatch batch(tally.grid());
  batch.add(path_of({stay(1, 1, 4, 1, 1)}, End::Stopped), 1000.0, 0, nullptr);                       // 2 kJ
  batch.add(path_of({stay(1, 1, 36, 2, 1)}, End::Left), 1000.0, 0, nullptr);                         // 18 kJ
  batch.add(path_of({stay(1, 1, 64, 1.5F), stay(2, 1, 144, 3)}, End::Stopped), 1000.0, 0, nullptr);  // 32, 72 kJ
  batch.add(path_of({stay(2, 1, 16, 0, 1), stay(2, 1, 4, 1, 1)}, End::Caught), 1000.0, 1, nullptr);  // 8 kJ
  batch.add(path_of({stay(2, 1, 100, 0)}, End::Left), 1000.0, 1, nullptr);                           // 50 kJ
  tally.add(batch);
  return tally;
}

using Bands = std::vector<std::vector<double>>;  // [band][cell]

/// A map as full bands, filled row by row.
Bands filled(const Map& map, int columns, int rows) {
  const auto across = static_cast<std::size_t>(columns);
  Bands bands(map.bands.size());
  std::vector<double> row_values(map.bands.size() * across);
  for (int row = 0; row < rows; ++row) {
    test::fill_row(map, row, row_values);
    for (std::size_t band = 0; band < bands.size(); ++band)
      bands[band].insert(bands[band].end(), row_values.begin() + static_cast<std::ptrdiff_t>(band * across),
                         row_values.begin() + static_cast<std::ptrdiff_t>((band + 1) * across));
  }
  return bands;
}

std::map<std::string, Bands> all_maps(const Scenario& s, const Tally& tally) {
  std::map<std::string, Bands> maps;
  for (const Map& map : make_maps(s, tally)) maps[map.name] = filled(map, tally.grid().columns, tally.grid().rows);
  return maps;
}

std::size_t at(int column, int row) {
  return static_cast<std::size_t>(row * kColumns + column);
}

TEST(Maps, NamesAndBandsOfTheDocs) {
  const Scenario s = small();
  const Tally tally = by_hand(s);
  const std::map<std::string, std::size_t> expected{{"impact_probability", 3},
                                                    {"reach_probability", 3},
                                                    {"energy_exceedance", 6},
                                                    {"height_exceedance", 3},
                                                    {"energy", 5},
                                                    {"velocity", 5},
                                                    {"jump_height", 5},
                                                    {"passages", 1},
                                                    {"impacts", 1},
                                                    {"deposits", 1},
                                                    {"sources", 1},
                                                    {"release", 1},
                                                    {"energy_total", 0},
                                                    {"energy_bounds", 0}};
  std::map<std::string, std::size_t> found;
  for (const Map& map : make_maps(s, tally)) {
    found[map.name] = map.bands.size();
    for (const Map::Band& band : map.bands) EXPECT_FALSE(band.name.empty() || band.unit.empty()) << map.name;
    if (map.name == "energy") {
      EXPECT_EQ(map.bands[2].unit, "kJ");
    }
    if (map.name == "energy_exceedance") {
      EXPECT_EQ(map.bands[1].name, "P(E > 50 kJ)");
    }
  }
  for (const auto& [name, bands] : expected) EXPECT_EQ(found[name], bands) << name;
}

TEST(Maps, ProbabilitiesByHand) {
  const Scenario s = small();
  const Tally tally = by_hand(s);
  auto maps = all_maps(s, tally);
  EXPECT_EQ(maps["impact_probability"][0][at(1, 1)], 3.0 / 20.0);
  EXPECT_EQ(maps["impact_probability"][0][at(2, 1)], 3.0 / 20.0);
  EXPECT_NEAR(maps["impact_probability"][1][at(1, 1)], 0.0321, 5e-5);  // 3 of 20: 3.21 % to 37.89 % (tables)
  EXPECT_NEAR(maps["impact_probability"][2][at(1, 1)], 0.3789, 5e-5);
  EXPECT_EQ(maps["reach_probability"][0][at(1, 1)], 3.0 / 10.0);  // source 0 alone reaches it
  EXPECT_EQ(maps["reach_probability"][0][at(2, 1)], 3.0 / 20.0);
  EXPECT_EQ(maps["release"][0][at(1, 1)], 20.0);
  EXPECT_EQ(maps["release"][0][at(2, 1)], 0.0);
  EXPECT_EQ(maps["energy_exceedance"][0][at(1, 1)], 2.0 / 20.0);  // 18 and 32 above 10 kJ
  EXPECT_EQ(maps["energy_exceedance"][1][at(1, 1)], 0.0);
  EXPECT_EQ(maps["energy_exceedance"][0][at(2, 1)], 2.0 / 20.0);  // 72 and 50
  EXPECT_EQ(maps["energy_exceedance"][1][at(2, 1)], 1.0 / 20.0);  // 50 itself is not above 50
  EXPECT_EQ(maps["height_exceedance"][0][at(1, 1)], 1.0 / 20.0);
  EXPECT_EQ(maps["height_exceedance"][0][at(2, 1)], 1.0 / 20.0);
}

TEST(Maps, CountsByHand) {
  const Scenario s = small();
  const Tally tally = by_hand(s);
  auto maps = all_maps(s, tally);
  EXPECT_EQ(maps["passages"][0][at(1, 1)], 3.0);
  EXPECT_EQ(maps["passages"][0][at(2, 1)], 3.0);
  EXPECT_EQ(maps["impacts"][0][at(1, 1)], 2.0);
  EXPECT_EQ(maps["impacts"][0][at(2, 1)], 2.0);
  EXPECT_EQ(maps["deposits"][0][at(1, 1)], 1.0);
  EXPECT_EQ(maps["deposits"][0][at(2, 1)], 2.0);
  EXPECT_EQ(maps["sources"][0][at(1, 1)], 1.0);
  EXPECT_EQ(maps["sources"][0][at(2, 1)], 2.0);
}

TEST(Maps, QuantitiesByHand) {
  const Scenario s = small();
  const Tally tally = by_hand(s);
  auto maps = all_maps(s, tally);
  const Bands &energy = maps["energy"], &speed = maps["velocity"], &height = maps["jump_height"];
  EXPECT_NEAR(energy[0][at(1, 1)], (2.0 + 18.0 + 32.0) / 3.0, 0x1p-11);
  EXPECT_NEAR(energy[1][at(1, 1)], 18.0, 0.0625 * 18.0);
  EXPECT_NEAR(energy[2][at(1, 1)], 32.0, 0.0625 * 32.0);
  EXPECT_EQ(energy[4][at(1, 1)], 32.0);
  EXPECT_NEAR(speed[0][at(2, 1)], (12.0 + 4.0 + 10.0) / 3.0, 0x1p-17);
  EXPECT_EQ(speed[4][at(2, 1)], 12.0);
  EXPECT_NEAR(height[0][at(2, 1)], (3.0 + 1.0 + 0.0) / 3.0, 0x1p-17);
  EXPECT_EQ(height[4][at(2, 1)], 3.0);
}

TEST(Maps, PercentilesOfAHundredTrajectories) {  // 2000 kg: energies 1.06^0 to 1.06^99 kJ
  Scenario s = small();
  s.trajectories = 50;
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  VisitBatch batch(tally.grid());
  const auto value = [](int i) { return static_cast<float>(std::pow(1.06, i)); };
  for (int i = 0; i < 100; ++i)
    batch.add(path_of({stay(1, 1, value(i), value(i))}, End::Left), 2000.0, static_cast<std::uint32_t>(i / 50),
              nullptr);
  tally.add(batch);
  auto maps = all_maps(s, tally);
  for (const char* name : {"energy", "jump_height"}) {
    EXPECT_NEAR(maps[name][1][at(1, 1)], value(49), 0.0625 * value(49));
    EXPECT_NEAR(maps[name][2][at(1, 1)], value(94), 0.0625 * value(94));
    EXPECT_NEAR(maps[name][3][at(1, 1)], value(98), 0.0625 * value(98));
  }
  EXPECT_NEAR(maps["velocity"][2][at(1, 1)], std::sqrt(value(94)), 0.0625 * std::sqrt(value(94)));
}

TEST(Maps, NothingCrossedAndNoTerrain) {
  const Scenario s = small();
  const Tally tally = by_hand(s);
  std::set<std::string> quantities;
  for (const Map& map : make_maps(s, tally))
    if (map.kind == Map::Kind::Quantity && map.name != "passage_density") quantities.insert(map.name);
  const double longest = std::hypot(s.surface.grid().cell_x, s.surface.grid().cell_y);
  for (const auto& [name, bands] : all_maps(s, tally))
    for (std::size_t band = 0; band < bands.size(); ++band) {
      EXPECT_TRUE(std::isnan(bands[band][at(5, 3)])) << name << ' ' << band;
      const double untouched = bands[band][at(4, 0)];
      if (quantities.contains(name))
        EXPECT_TRUE(std::isnan(untouched)) << name << ' ' << band;
      else if ((name == "impact_probability" && band == 2) ||
               (name == "energy_exceedance" && band % 2 == 1 && band > 2) || (name == "height_exceedance" && band == 2))
        EXPECT_NEAR(untouched, 0.1684, 5e-5);  // 0 of 20 (tables)
      else if (name == "reach_probability" && band == 2)
        EXPECT_NEAR(untouched, 0.3085, 5e-5);           // 0 of the 10 of one source cell
      else if (name == "passage_density" && band == 2)  // 0 of 20 ways as long as the diagonal: -ln 0.025 of them
        EXPECT_NEAR(untouched, 3.688879 * longest / (s.surface.grid().cell_x * s.surface.grid().cell_y * 20.0), 1e-5);
      else
        EXPECT_EQ(untouched, 0.0) << name << ' ' << band;
    }
}

TEST(Maps, ARowDoesNotDependOnTheOrderOfTheCalls) {
  const Scenario s = small();
  const Tally tally = by_hand(s);
  for (const Map& map : make_maps(s, tally)) {
    std::vector<double> first(map.bands.size() * kColumns), again(first.size());
    test::fill_row(map, 1, first);
    test::fill_row(map, 3, again);
    test::fill_row(map, 1, again);
    for (std::size_t i = 0; i < first.size(); ++i)
      EXPECT_TRUE(first[i] == again[i] || (std::isnan(first[i]) && std::isnan(again[i]))) << map.name << ' ' << i;
  }
}

TEST(Maps, LawsOfASimulatedRun) {
  const Scenario s = test::rough_slope(5, 200);
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  const Totals totals = simulate(s, tally, {}, 2);
  auto maps = all_maps(s, tally);
  const Bands &probability = maps["impact_probability"], &reach = maps["reach_probability"];
  std::size_t touched = 0;
  for (std::size_t cell = 0; cell < probability[0].size(); ++cell) {
    const double p = probability[0][cell];
    ASSERT_LE(probability[1][cell], p);
    ASSERT_GE(probability[2][cell], p);
    ASSERT_GE(reach[0][cell], p);
    ASSERT_LE(reach[0][cell], 1.0);
    ASSERT_LE(reach[1][cell], reach[0][cell]);
    ASSERT_GE(reach[2][cell], reach[0][cell]);
    for (const char* name : {"energy_exceedance", "height_exceedance"}) {
      double above = p;
      const Bands& bands = maps[name];
      const std::size_t thresholds = bands.size() / 3;
      for (std::size_t i = 0; i < thresholds; ++i) {
        ASSERT_LE(bands[i][cell], above) << name;
        above = bands[i][cell];
        ASSERT_LE(bands[thresholds + 2 * i][cell], above) << name;
        ASSERT_GE(bands[thresholds + 2 * i + 1][cell], above) << name;
      }
    }
    if (p == 0.0) continue;
    ++touched;
    for (const char* name : {"energy", "velocity", "jump_height"}) {
      const Bands& b = maps[name];
      ASSERT_GE(b[0][cell], 0.0) << name;
      ASSERT_LE(b[0][cell], b[4][cell]) << name;  // mean <= maximum
      for (std::size_t band = 1; band < 4; ++band) ASSERT_LE(b[band][cell], b[band + 1][cell]) << name << ' ' << band;
    }
  }
  EXPECT_EQ(touched, tally.touched_cells());
  const auto sum = [&maps](const char* name) {
    return std::accumulate(maps[name][0].begin(), maps[name][0].end(), 0.0);
  };
  const auto count = [&totals](End end) { return static_cast<double>(totals.ends[static_cast<std::size_t>(end)]); };
  EXPECT_EQ(sum("deposits"), count(End::Stopped) + count(End::Trapped));
  EXPECT_EQ(sum("trapped"), count(End::Trapped));
  EXPECT_EQ(sum("exits"), count(End::Left));
}

}  // namespace
}  // namespace talus
