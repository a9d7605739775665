// The table of rasters is complete and agrees with docs; the bands of a run follow from it.
#include "talus/products/raster_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "talus/products/hazard_table.hpp"

namespace talus {
namespace {

const RunCounts kRun{100, 10.0, thresholds_of({30.0}, {1.0}), 1.0, 1.0, 0.0, true, true};

const RunRaster& raster_of(const std::string& name) {
  for (const RunRaster& raster : run_rasters())
    if (raster.map.name == name) return raster;
  throw std::out_of_range("no raster " + name);
}

/// The values of a cell in `bands` bands.
std::vector<double> values_of(const std::string& name, const CellRecord& record, std::size_t bands) {
  std::vector<double> values(bands);
  raster_of(name).rule(kRun)({record, nullptr}, values);
  return values;
}

/// The row of a page's tables that describes a file; empty where there is none.
std::string row_of(const std::string& page, const std::string& name) {
  std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/docs/" + page);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("| `" + name + ".tif` |")) return line;
  return {};
}

void expect_described(const std::string& page, const Map& map, const std::vector<Map::Band>& bands,
                      const std::string& meaning) {
  const std::string row = row_of(page, map.name);
  ASSERT_FALSE(row.empty()) << page << " has no row of " << map.name << ".tif";
  EXPECT_THAT(row, testing::HasSubstr("| " + meaning + " |"));
  EXPECT_FALSE(meaning.empty()) << map.name;
  for (const Map::Band& band : bands) {
    EXPECT_THAT(row, testing::HasSubstr("`" + band.name + "`"));
    EXPECT_THAT(row, testing::ContainsRegex("[|,] " + band.unit + "[ ,]")) << "unit of " << band.name;
  }
}

void expect_legend(const Map& map, const std::vector<Map::Band>& bands) {
  const Legend& legend = map.legend;
  ASSERT_FALSE(legend.limits.empty()) << map.name;
  EXPECT_TRUE(std::ranges::is_sorted(legend.limits)) << map.name;
  const std::size_t above = map.kind == Map::Kind::Probability ? 0 : 1;  // nothing is above 100 %
  EXPECT_LE(legend.limits.size() + above, 6U) << "colours, of which one is above the last: " << map.name;
  EXPECT_GT(legend.factor, 0.0) << map.name;
  const bool shown =
      legend.band.empty() || std::ranges::any_of(bands, [&](const auto& b) { return b.name == legend.band; });
  EXPECT_TRUE(shown) << map.name << " has no band " << legend.band;
  const std::string& unit = bands.front().unit;
  const bool counted = unit == "count" || unit == "class";
  EXPECT_EQ(legend.unit, counted ? "" : unit == "1" ? "%" : unit) << map.name;
  EXPECT_EQ(legend.factor, unit == "1" ? 100.0 : 1.0) << map.name;
}

TEST(RasterTable, EveryRasterOfARunIsInTheDocsAndHasALegend) {
  std::set<std::string> names;
  for (const RunRaster& raster : run_rasters()) {
    const std::vector<Map::Band> bands = bands_of(raster, kRun);
    EXPECT_TRUE(names.insert(raster.map.name).second) << raster.map.name << " twice";
    EXPECT_FALSE(bands.empty() || raster.map.title.empty()) << raster.map.name;
    EXPECT_NE(raster.rule == nullptr, raster.of_scenario == nullptr) << raster.map.name;
    expect_described("products.md", raster.map, bands, raster.meaning);
    expect_legend(raster.map, bands);
  }
}

TEST(RasterTable, EveryRasterOfTheHazardIsInTheDocsAndHasALegend) {
  for (const HazardRaster& raster : hazard_rasters()) {
    EXPECT_FALSE(raster.map.title.empty() || !raster.figures) << raster.map.name;
    expect_described("hazard.md", raster.map, raster.map.bands, raster.meaning);
    expect_legend(raster.map, raster.map.bands);
  }
}

TEST(RasterTable, EveryQuantityHasARaster) {
  for (const QuantityEntry& entry : kQuantityTable)
    EXPECT_EQ(raster_of(std::string(entry.name)).map.bands.front().unit, entry.unit);
}

TEST(RasterTable, ABandForEachThreshold) {
  const RunCounts run{100, 10.0, thresholds_of({0.5, 1000.0}, {})};
  const std::vector<Map::Band> energies = bands_of(raster_of("energy_exceedance"), run);
  ASSERT_EQ(energies.size(), 6U);
  EXPECT_EQ(energies[0].name, "P(E > 0.5 kJ)");
  EXPECT_EQ(energies[1].name, "P(E > 1000 kJ)");
  EXPECT_EQ(energies[2].name, "P(E > 0.5 kJ) lower 95 % bound");
  EXPECT_EQ(energies[5].name, "P(E > 1000 kJ) upper 95 % bound");
  EXPECT_TRUE(bands_of(raster_of("height_exceedance"), run).empty());
  EXPECT_EQ(bands_of(raster_of("impact_probability"), run).size(), 3U);
}

TEST(RasterTable, ACellByHand) {  // 4 of 100 trajectories, of 2 source cells with 10 each
  CellRecord cell;
  cell.passages = 4;
  cell.sources = 2;
  cell.impacts = 6;
  cell.deposits = 3;
  cell.trapped = 2;
  cell.exits = 1;
  EXPECT_EQ(values_of("deposits", cell, 1)[0], 3.0);
  EXPECT_EQ(values_of("trapped", cell, 1)[0], 2.0);
  EXPECT_EQ(values_of("exits", cell, 1)[0], 1.0);
  EXPECT_EQ(values_of("reach_probability", cell, 3)[0], 4.0 / 20.0);
  EXPECT_EQ(values_of("impact_probability", cell, 3)[0], 4.0 / 100.0);
  EXPECT_EQ(values_of("impacts", cell, 1)[0], 6.0);
}

TEST(RasterTable, BoundsOfExceedancesByHand) {  // 5 and 0 of 10 trajectories: Geigy Scientific Tables
  RunCounts run{10, 10.0, thresholds_of({30.0, 300.0}, {})};
  const std::uint32_t over[] = {5, 0};
  std::vector<double> values(6);
  raster_of("energy_exceedance").rule(run)({CellRecord(), over}, values);
  EXPECT_EQ(values[0], 0.5);
  EXPECT_EQ(values[1], 0.0);
  EXPECT_NEAR(values[2], 0.1871, 5e-5);
  EXPECT_NEAR(values[3], 0.8129, 5e-5);
  EXPECT_EQ(values[4], 0.0);
  EXPECT_NEAR(values[5], 0.3085, 5e-5);
  const std::vector<double> untouched = raster_of("energy_exceedance").untouched(run);
  ASSERT_EQ(untouched.size(), 6U);
  EXPECT_EQ(untouched[2], 0.0);
  EXPECT_NEAR(untouched[5], 0.3085, 5e-5);
}

TEST(RasterTable, WhatIsWrittenOnRequestOnly) {
  RunCounts run = kRun;
  run.energy_total = run.bounds = false;
  for (const char* name : {"energy_total", "energy_bounds", "velocity_bounds", "jump_height_bounds"}) {
    EXPECT_TRUE(bands_of(raster_of(name), run).empty()) << name;
    EXPECT_FALSE(bands_of(raster_of(name), kRun).empty()) << name;
  }
}

TEST(RasterTable, PercentileBoundsByHand) {  // 10 values: the median lies between the 2nd and the 9th
  CellRecord cell;
  CellValues values;
  values.make_room(10);
  values.count = 10;
  for (std::size_t i = 0; i < 10; ++i)
    for (auto& list : values.lists) list[i] = static_cast<float>(16 * (i + 1));  // 16, 32, ... are edges of bins
  cell.add(values);
  const std::vector<double> bounds = values_of("energy_bounds", cell, 6);
  EXPECT_EQ(bounds[0], 32.0);
  EXPECT_EQ(bounds[1], 152.0) << "144 is in the bin from 144 to 152";
  EXPECT_EQ(bounds[2], 128.0) << "P95: P(at most 7 of 10 below it) = 1.15 %, at most 8: 8.6 %; so the 8th";
  EXPECT_TRUE(std::isnan(bounds[3])) << "too few for an upper bound";
}

TEST(RasterTable, PassageDensityByHand) {  // 4 blocks of 100 cross 2 x 3 m, 12 m in all, 3 m of it above the threshold
  RunCounts run{100, 10.0, thresholds_of({30.0}, {}), 2.0, 3.0};
  CellRecord cell;
  cell.passages = 4;
  cell.length = 12 << 20;
  cell.length_squares = 36 << 20;  // of 3 m each
  const std::int64_t above = 3 << 20;
  std::vector<double> values(4);
  raster_of("passage_density").rule(run)({cell, nullptr, &above}, values);
  EXPECT_EQ(values[0], 12.0 / (6.0 * 100.0));
  EXPECT_EQ(values[3], 3.0 / (6.0 * 100.0));
  EXPECT_NEAR(values[1], 3.0 * 1.0899 / 600.0, 1e-5) << "Garwood's lower bound of 4 counts";
  EXPECT_GE(values[2], 3.0 * 9.0 / 600.0);
  EXPECT_LE(values[2], 3.0 * 10.2416 / 600.0 * 1.07) << "the unit is the diagonal, 3.6 m, not the 3 m of each block";
  EXPECT_NEAR(raster_of("passage_density").untouched(run)[2], std::hypot(2.0, 3.0) * 3.6889 / 600.0, 1e-6);
  EXPECT_EQ(raster_of("passage_density").untouched(run).size(), 4U);
  EXPECT_EQ(bands_of(raster_of("passage_density"), run)[0].name, "passage density (in plan, at any height)");
  run.passages_below = 8.0;
  EXPECT_EQ(bands_of(raster_of("passage_density"), run)[0].name,
            "passage density (in plan, lower than 8 m above the terrain)");
}

TEST(Quantities, OfACubicMetreOfRockAtTenMetresPerSecond) {  // 2700 kg: 135 kJ
  const Maxima maxima{100.0F, 1.5F};
  EXPECT_EQ(kQuantityTable[index_of(Quantity::Energy)].value(maxima, 2700.0), 135.0F);
  EXPECT_EQ(kQuantityTable[index_of(Quantity::Speed)].value(maxima, 2700.0), 10.0F);
  EXPECT_EQ(kQuantityTable[index_of(Quantity::Height)].value(maxima, 2700.0), 1.5F);
}

/// Rasters with thresholds of the energy say that it is with rotation, if it is; the others keep their words.
TEST(RasterTable, SaysWhichEnergyCounts) {
  for (const bool with : {false, true}) {
    for (const RunRaster& raster : run_rasters(with)) {
      const bool counted = with && raster.thresholds_of == Quantity::Energy;
      if (raster.map.name == "energy_exceedance")
        EXPECT_EQ(raster.map.title.find("with rotation") != std::string::npos, with);
      else
        EXPECT_EQ(raster.map.title, raster_of(raster.map.name).map.title);
      for (const Map::Band& band : bands_of(raster, kRun))
        EXPECT_EQ(band.name.find("E with rotation >") != std::string::npos,
                  counted && band.name.find(" > ") != std::string::npos)
            << band.name;
    }
  }
}

}  // namespace
}  // namespace talus
