#include "talus/fit/diagnose/detection_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/campaigns.hpp"
#include "talus/fit/diagnose/candidates.hpp"

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
  const auto limits = detection_limits(Campaign{}, Axis{}, test_with_error(1.0), candidates, {});
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_DOUBLE_EQ(limits[0].off, 0.0);
  EXPECT_DOUBLE_EQ(limits[0].amount, 0.9);  // 4.5 x 0.2
}

TEST(DetectionLimits, BeyondItsBoundsAnEffectIsNotSeen) {
  const std::vector<Candidate> candidates{drag()};
  EXPECT_DOUBLE_EQ(detection_limits(Campaign{}, Axis{}, test_with_error(2.0), candidates, {})[0].amount, 1.8);
  EXPECT_TRUE(std::isnan(detection_limits(Campaign{}, Axis{}, test_with_error(2.3), candidates, {})[0].amount));
}

/// The number that is measured best would have to go beyond its bounds: the other one shows the effect.
TEST(DetectionLimits, AreOfAParameterThatCanShowTheEffect) {
  Candidate two = drag();
  two.parameters.push_back(two.parameters.front());
  two.parameters[0].key = "damping", two.parameters[0].upper = 0.5;
  two.tested = 2;
  ScoreTest test;
  test.effects.push_back({"air-drag", {}, {}, 1.0, {}, {{"damping", {{0}, 0, 1.0}}, {"drag", {{0}, 1, 1.1}}}});
  const auto limits = detection_limits(Campaign{}, Axis{}, test, std::vector<Candidate>{two}, {});
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_EQ(limits[0].key, "drag");
  EXPECT_DOUBLE_EQ(limits[0].amount, 0.99);
}

/// Two places, of which the second measures the drag best.
TEST(DetectionLimits, AreGivenForEachPlace) {
  std::vector<Candidate> candidates{drag(), drag()};
  candidates[1].where = "zone meadow";
  ScoreTest test = test_with_error(1.0);
  test.effects[0].sharpest = {{"drag", {{1}, 0, 0.5}}};
  test.effects[0].places = {{{0}, 0, 1.0}, {{1}, 0, 0.5}};
  std::vector<DetectionLimit> limits = detection_limits(Campaign{}, Axis{}, test, candidates, {});
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_DOUBLE_EQ(limits[0].amount, 0.45);
  ASSERT_EQ(limits[0].places.size(), 2U);
  EXPECT_EQ(limits[0].places[0].where, "everywhere");
  EXPECT_DOUBLE_EQ(limits[0].places[0].amount, 0.9);
  EXPECT_EQ(limits[0].places[1].where, "zone meadow");
  EXPECT_DOUBLE_EQ(limits[0].places[1].amount, 0.45);
  complete_limits(limits, {}, {});  // no family that could name it
  EXPECT_TRUE(std::isnan(limits[0].places[1].amount));
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
  std::vector<DetectionLimit> limits = detection_limits(Campaign{}, Axis{}, test, std::vector<Candidate>{two}, {});
  test.effects[0].sharpest = {{"softening", {{0}, 0, 0.5}}, {"drag", {{0}, 1, 0.25}}};
  compare_limits(limits, limits_by_parameter(Campaign{}, Axis{}, test, std::vector<Candidate>{two}, {}));
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

/// A model whose samples are read 20 % too low, a campaign with a further screen: the samples keep their error, and the
/// screen has none.
TEST(FurtherScreens, HaveNoBiasAndTheSamplesKeepTheirs) {
  Campaign campaign = slope_campaign(6);
  campaign.error = {};
  for (MeasuredBlock& block : campaign.blocks) block.samples = {{.x = block.x, .y = block.y - 20.0, .distance = 20.0}};
  const Model plain = model_of_preset(campaign, "upper-talus-3d");
  Model biased = plain;
  biased.bias.resize(1);
  biased.bias[kSampler].speed = -0.2;
  const Campaign more = with_further_screens(campaign, {{60.0, 190.0}, {0.0, -1.0}, 0.0, 150.0}, {});
  const auto without = observe(more, plain, {20, 1, 0, 1, {}, {}}), with = observe(more, biased, {20, 1, 0, 1, {}, {}});
  double seen = 0.0, crossed = 0.0;
  for (std::size_t b = 0; b < with.size(); ++b)
    for (std::size_t t = 0; t < 20; ++t) {
      const double sample = with[b].samples[0].speed[t];
      if (!std::isnan(sample)) {
        EXPECT_NEAR(sample, 0.8 * without[b].samples[0].speed[t], 1e-12);
        seen += 1.0;
      }
      for (std::size_t s = 0; s < more.screens.size(); ++s) {
        const double speed = with[b].screens[s].speed[t];
        if (std::isnan(speed)) continue;
        EXPECT_EQ(speed, without[b].screens[s].speed[t]);
        crossed += 1.0;
      }
    }
  EXPECT_GT(seen, 20.0);
  EXPECT_GT(crossed, 20.0);
}

/// Who measures more knows more: what a campaign shows, it shows with further speeds, too; from no larger amount on,
/// but for the noise of the trials.
TEST(FurtherScreens, RaiseNoLimit) {
  Campaign campaign = slope_campaign(24);
  const Model model = model_of_preset(campaign, "upper-talus-3d");
  measure(campaign, model, 3);
  const std::vector<bool> rows(campaign.blocks.size(), true);
  const ObserveOptions unseen{100, 7, 1000, 0, {}, {}};
  const auto runs = observe(campaign, model, unseen);
  const Axis axis = axis_of(campaign, runs);
  const auto list = candidates_of(campaign, model, runs, {}, {});
  const auto free = ground_parameters(campaign, model, std::vector<std::string>{"theta_scale", "En50"}, {true});
  const Eigen::VectorXd z = Eigen::VectorXd::Zero(2);
  ScoreTestOptions how;
  how.trials = 40;
  how.replicates = 0;
  const auto tested = [&](const Campaign& c) {
    return score_test(c, {model, free, z, observe(c, model, unseen)}, list, rows, how);
  };
  const Campaign more = with_further_screens(campaign, axis, {});
  std::vector<DetectionLimit> limits = detection_limits(campaign, axis, tested(campaign), list, {});
  compare_limits(limits, limits_by_parameter(more, axis, tested(more), list, {}));
  int finite = 0;
  for (const DetectionLimit& limit : limits) {
    if (std::isnan(limit.amount)) continue;
    ++finite;
    std::set<std::string> places;
    for (const auto& [where, amount] : limit.places) {
      EXPECT_TRUE(places.insert(where).second)
          << limit.effect << ": joined places are no places of their own: " << where;
      if (!std::isnan(amount)) EXPECT_LE(std::abs(limit.amount - limit.off), std::abs(amount - limit.off)) << where;
    }
    EXPECT_LE(std::abs(limit.with_further_speeds - limit.off), 1.05 * std::abs(limit.amount - limit.off))
        << limit.effect << ' ' << limit.key;
  }
  EXPECT_GE(finite, 3);
}

}  // namespace
}  // namespace talus::test
