#include "talus/products/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

using Values = std::vector<double>;
using testing::ElementsAre;
using testing::NanSensitiveDoubleEq;

const double kNone = std::nan("");

ComparedRaster raster_of(const std::string& name, std::vector<Map::Band> bands) {
  ComparedRaster raster = compared_raster(name).value();
  raster.map.bands = std::move(bands);
  return raster;
}

ComparedRaster energy() {
  return raster_of("energy", {{"mean", "kJ"}, {"P50", "kJ"}, {"P95", "kJ"}, {"P99", "kJ"}, {"maximum", "kJ"}});
}

ComparedRaster bounded(const std::string& name) {
  return raster_of(name, {{"value", "1"}, {"lower 95 % bound", "1"}, {"upper 95 % bound", "1"}});
}

ComparedRaster classes() {
  ComparedRaster raster = compared_raster("hazard_class").value();
  raster.map.classes = {"none", "residual", "low", "medium", "high"};
  return raster;
}

Values worst_of(const ComparedRaster& raster, const std::vector<Values>& runs) {
  Values worst(runs.front().size());
  take_worst(raster, runs, worst);
  return worst;
}

Values change_of(const ComparedRaster& raster, const std::vector<Values>& runs) {
  Values change(runs.front().size() / raster.map.bands.size() * change_map(raster).bands.size());
  take_change(raster, runs, change);
  return change;
}

TEST(Comparison, RastersByName) {
  for (const char* name :
       {"impact_probability", "reach_probability", "energy_exceedance", "height_exceedance", "passage_density",
        "energy", "energy_total", "velocity", "jump_height", "hazard_class", "annual_frequency", "return_period_300",
        "return_period_2.5", "intensity_T30", "hazard_curves"}) {
    ASSERT_TRUE(compared_raster(name)) << name;
    EXPECT_EQ(compared_raster(name)->map.name, name);
    EXPECT_EQ(compared_raster(name)->lower_is_worse, std::string(name).starts_with("return_period")) << name;
  }
  for (const char* name : {"passages", "deposits", "release", "sources", "energy_bounds", "return_period_",
                           "return_period_x", "return_period_<kJ>", "energy.tif", ""})
    EXPECT_FALSE(compared_raster(name)) << name;
}

TEST(Comparison, TheHighestOfEachBandWhereAnyRunIs) {
  const Values a{1, 2, 3, 4, 5, kNone, kNone, kNone, kNone, kNone};
  const Values b{2, 1, 3, 5, 4, 6, 7, 8, 9, 10}, c{0, 0, 9, 0, 0, kNone, kNone, kNone, kNone, kNone};
  EXPECT_EQ(worst_of(energy(), {a, b, c}), (Values{2, 2, 9, 5, 5, 6, 7, 8, 9, 10}));
  EXPECT_TRUE(std::isnan(worst_of(energy(), {a, a, c})[7]));
  EXPECT_EQ(worst_map(energy(), 3).name, "highest_energy");
}

TEST(Comparison, TheLowestReturnPeriod) {
  const ComparedRaster periods = bounded("return_period_300");
  EXPECT_THAT(worst_of(periods, {{100, 50, kNone}, {30, 20, 60}}), ElementsAre(30, 20, 60));
  EXPECT_THAT(worst_of(periods, {{kNone, 400, kNone}, {300, 200, 900}}), ElementsAre(300, 200, 900));
  EXPECT_EQ(worst_map(periods, 2).name, "lowest_return_period_300");
  EXPECT_TRUE(worst_map(periods, 2).smallest_in_overviews);
}

TEST(Comparison, AClassIsDecidedIfTheWorstBoundsAgree) {
  // class, at the lower bound, at the upper bound, undecided, cut short
  EXPECT_EQ(worst_of(classes(), {{3, 3, 3, 0, 0}, {2, 1, 3, 1, 1}}), (Values{3, 3, 3, 0, 1}));
  EXPECT_EQ(worst_of(classes(), {{2, 2, 2, 0, 0}, {2, 1, 4, 1, 0}}), (Values{2, 2, 4, 1, 0}));
}

TEST(Comparison, ChangeIsSecondMinusFirst) {
  const Values a{1, 2, 3, 4, 5, kNone, kNone, kNone, kNone, kNone}, b{2, 2, 1, 9, 5, 1, 2, 3, 4, 5};
  EXPECT_EQ(change_of(energy(), {a, b}), (Values{1, 0, -2, 5, 0, 1, 2, 3, 4, 5})) << "0 where a run does not come";
  EXPECT_EQ(change_of(energy(), {b, a}), (Values{-1, 0, 2, -5, 0, -1, -2, -3, -4, -5}));
  EXPECT_THAT(change_of(energy(), {Values(5, kNone), Values(5, kNone)}), testing::Each(NanSensitiveDoubleEq(kNone)));
}

TEST(Comparison, NothingIsKnownWhereOneRunHasNoTerrain) {
  const Values here{0.2, 0.1, 0.3}, no_terrain(3, kNone);
  EXPECT_TRUE(std::isnan(change_of(bounded("annual_frequency"), {here, no_terrain})[0]));
  ComparedCells cells(2);
  cells.add(bounded("annual_frequency"), std::vector<Values>{here, no_terrain});
  EXPECT_THAT(cells.alone, ElementsAre(0, 0));
}

TEST(Comparison, BoundsApart) {
  const ComparedRaster raster = bounded("reach_probability");
  ASSERT_EQ(change_map(raster).bands.size(), 2U);
  EXPECT_EQ(change_map(raster).bands[1].name, "bounds apart");
  const Values low{0.2, 0.1, 0.3}, high{0.5, 0.4, 0.6}, touching{0.4, 0.3, 0.5};
  EXPECT_THAT(change_of(raster, {low, high}), ElementsAre(testing::DoubleEq(0.3), 1));
  EXPECT_THAT(change_of(raster, {high, low}), ElementsAre(testing::DoubleEq(-0.3), 1));
  EXPECT_EQ(change_of(raster, {low, touching})[1], 0);
}

TEST(Comparison, NoReturnPeriodIsOneWithoutEnd) {
  const ComparedRaster raster = bounded("return_period_30");
  const Values never{kNone, 400, kNone}, often{100, 50, 300}, open{100, 50, kNone};
  EXPECT_THAT(change_of(raster, {never, often}), ElementsAre(NanSensitiveDoubleEq(kNone), 1));
  EXPECT_THAT(change_of(raster, {never, open}), ElementsAre(NanSensitiveDoubleEq(kNone), 0));
  EXPECT_THAT(change_of(raster, {often, often}), ElementsAre(0, 0));
  ComparedCells cells(2);
  cells.add(raster, std::vector<Values>{never, often});
  EXPECT_THAT(cells.worse, ElementsAre(0, 1));
  EXPECT_THAT(cells.alone, ElementsAre(0, 1));
}

TEST(Comparison, ChangeOfClassesHasOneBandAndNames) {
  const Map map = change_map(classes());
  ASSERT_EQ(map.bands.size(), 1U);  // no bounds, no marks
  EXPECT_EQ(map.bands[0].name, "change of class");
  EXPECT_EQ(map.kind, Map::Kind::Quantity);  // it may be negative
  EXPECT_TRUE(map.marks.empty());
  EXPECT_EQ(map.classes.size(), map.legend.limits.size() + 1);
  EXPECT_THAT(change_of(classes(), {{4, 4, 4, 0, 1}, {1, 1, 2, 1, 0}}), ElementsAre(-3));
}

TEST(Comparison, Cells) {
  ComparedCells cells(2);
  const auto cell = [](double p95) { return Values{0, 0, p95, 0, 0}; };
  const Values none(5, kNone);
  for (const auto& [a, b] : {std::pair{cell(10), cell(30)}, {cell(20), cell(50)}, {cell(99), none}, {none, none}})
    cells.add(energy(), std::vector<Values>{a, b});
  EXPECT_THAT(cells.alone, ElementsAre(1, 0));
  EXPECT_EQ(cells.common, 2U);
  EXPECT_EQ(cells.mean(0), 15.0);
  EXPECT_EQ(cells.mean(1), 40.0);
  EXPECT_TRUE(std::isnan(ComparedCells(2).mean(0)));
}

TEST(Comparison, ReachedIsAboveZeroOrAValueWhereNothingIsNodata) {
  EXPECT_FALSE(bounded("impact_probability").reached(Values{0, 0, 0.1}));
  EXPECT_TRUE(bounded("impact_probability").reached(Values{0.1, 0, 0.2}));
  ComparedRaster jump = energy();
  jump.map.name = "jump_height";
  EXPECT_TRUE(jump.reached(Values{0, 0, 0, 0, 0}));  // a block that slides
  EXPECT_FALSE(jump.reached(Values(5, kNone)));
}

}  // namespace
}  // namespace talus
