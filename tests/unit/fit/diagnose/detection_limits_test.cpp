#include "talus/fit/diagnose/detection_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/scenes.hpp"

namespace talus::test {
namespace {

/// A candidate with a number on a linear scale: what one would notice is 0.2, the bound is 2.
Candidate drag() {
  return {"air-drag", "everywhere", {{"drag", "1", 0.0, 2.0, Parameter::Scale::Linear, 0.0, 0.8, {}, {}}}, 1, {}};
}

ScoreTest test_with_error(double standard_error) {
  ScoreTest test;
  test.effects.push_back({"air-drag", {}, {}, 1.0, {}, {{"drag", {{0}, 0, standard_error}}}});
  return test;
}

TEST(DetectionLimits, AreFourAndAHalfStandardErrors) {
  const std::vector<Candidate> candidates{drag()};
  const auto limits = detection_limits(Campaign{}, Axis{}, test_with_error(1.0), candidates);
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_DOUBLE_EQ(limits[0].off, 0.0);
  EXPECT_DOUBLE_EQ(limits[0].amount, 0.9);  // 4.5 x 0.2
}

TEST(DetectionLimits, BeyondItsBoundsAnEffectIsNotSeen) {
  const std::vector<Candidate> candidates{drag()};
  EXPECT_DOUBLE_EQ(detection_limits(Campaign{}, Axis{}, test_with_error(2.0), candidates)[0].amount, 1.8);
  EXPECT_TRUE(std::isnan(detection_limits(Campaign{}, Axis{}, test_with_error(2.3), candidates)[0].amount));
}

TEST(DetectionLimits, OfFurtherMeasurementsStandBesideTheirOwnEffect) {
  std::vector<DetectionLimit> limits{{.effect = "air-drag", .key = "drag"}, {.effect = "block-mass", .key = "m"}};
  const std::vector<DetectionLimit> further{{.effect = "block-mass", .key = "m", .amount = 0.3},
                                            {.effect = "wet-ground", .key = "drag", .amount = 0.1}};
  compare_limits(limits, further);
  EXPECT_TRUE(std::isnan(limits[0].with_further_speeds));
  EXPECT_DOUBLE_EQ(limits[1].with_further_speeds, 0.3);
}

/// Of two numbers the first is measured best, with further measurements the second: the first stands beside the first.
TEST(DetectionLimits, CompareTheSameParameter) {
  Candidate two = drag();
  two.parameters.push_back(two.parameters.front());
  two.parameters[0].key = "softening", two.parameters[1].key = "drag";
  two.tested = 2;
  ScoreTest test;
  test.effects.push_back({"air-drag", {}, {}, 1.0, {}, {{"softening", {{0}, 0, 1.0}}, {"drag", {{0}, 1, 2.0}}}});
  std::vector<DetectionLimit> limits = detection_limits(Campaign{}, Axis{}, test, std::vector<Candidate>{two});
  test.effects[0].sharpest = {{"softening", {{0}, 0, 0.5}}, {"drag", {{0}, 1, 0.25}}};
  compare_limits(limits, limits_by_parameter(Campaign{}, Axis{}, test, std::vector<Candidate>{two}));
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_EQ(limits[0].key, "softening");
  EXPECT_DOUBLE_EQ(limits[0].amount, 0.9);
  EXPECT_DOUBLE_EQ(limits[0].with_further_speeds, 0.45);  // not 0.225, of the drag
}

/// A family that cannot be tested, or that can name nothing, shows no amount of its effects; one that can is enough.
TEST(DetectionLimits, OfAnEffectThatNoFamilyCanNameIsNone) {
  FamilyTest property, place, day, dispersion;
  property.members = {"block-shape", "block-mass"};
  property.p_value = 0.2;
  property.may_name = false;  // three rocks
  place.members = {"rest-in-roughness"};
  place.p_value = 0.5;
  day.members = {"wet-ground"};  // one day in each group: p is not given
  dispersion.members = {"rest-in-roughness"};
  std::vector<DetectionLimit> limits;
  for (const char* effect : {"block-mass", "wet-ground", "rest-in-roughness"})
    limits.push_back({.effect = effect, .key = "a", .amount = 1.0, .with_further_speeds = 0.5});
  complete_limits(limits, std::vector<FamilyTest>{property, place, day, dispersion}, {});
  for (const std::size_t hidden : {0U, 1U}) {
    EXPECT_TRUE(std::isnan(limits[hidden].amount)) << limits[hidden].effect;
    EXPECT_TRUE(std::isnan(limits[hidden].with_further_speeds)) << limits[hidden].effect;
  }
  EXPECT_EQ(limits[2].amount, 1.0);
  EXPECT_EQ(limits[2].with_further_speeds, 0.5);
}

/// "For each effect that is not in the last model" (docs/detection-limits.md): the ten effects of docs/effects.md and
/// the three that are no effects of a block, with one limit each, also where nothing measured could show them.
TEST(DetectionLimits, OfAllEffectsThatWereNotFound) {
  const std::vector<std::string> found{"soft-ground"};
  std::vector<DetectionLimit> limits{{.effect = "air-drag", .key = "drag", .amount = 0.9}};
  complete_limits(limits, {}, found);
  std::multiset<std::string> names(found.begin(), found.end());
  for (const DetectionLimit& limit : limits) {
    names.insert(limit.effect);
    EXPECT_TRUE(std::isnan(limit.amount)) << limit.effect;
  }
  EXPECT_EQ(names,
            (std::multiset<std::string>{"air-drag", "block-mass", "block-shape", "forest-stems", "fragmentation",
                                        "instrument-bias", "rest-in-roughness", "rolling-resistance", "soft-ground",
                                        "undeclared-barrier", "undeclared-zone", "vegetation-drag", "wet-ground"}));
}

TEST(FurtherScreens, StandAcrossThePathAtEqualDistances) {
  Campaign campaign;
  campaign.screens = {{"S1", {}}};
  campaign.blocks.resize(2);
  campaign.blocks[0].passages.resize(1);
  DiagnosisRules rules;
  rules.further_screens = 3;
  const Axis axis{{10.0, 20.0}, {0.0, -1.0}, 0.0, 80.0};
  const Campaign more = with_further_screens(campaign, axis, rules);
  ASSERT_EQ(more.screens.size(), 4U);
  for (int i = 1; i <= 3; ++i) {
    const auto& line = more.screens[static_cast<std::size_t>(i)].lines.front();
    EXPECT_NEAR(line[0].y(), 20.0 - 20.0 * i, 1e-12);
    EXPECT_NEAR(line[1].y(), 20.0 - 20.0 * i, 1e-12);
    EXPECT_LT(std::min(line[0].x(), line[1].x()), -60.0);
    EXPECT_GT(std::max(line[0].x(), line[1].x()), 80.0);
  }
  for (const MeasuredBlock& block : more.blocks) {
    ASSERT_EQ(block.passages.size(), 4U);
    EXPECT_FALSE(block.passages[0].has_value());
    EXPECT_FALSE(std::isnan(block.passages[3]->speed));
    EXPECT_TRUE(std::isnan(block.passages[3]->jump));
  }
  EXPECT_EQ(campaign.screens.size(), 1U);
}

}  // namespace
}  // namespace talus::test
