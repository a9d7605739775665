#include "talus/fit/diagnose/property_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/scenes.hpp"

namespace talus::test {
namespace {

/// Blocks of many shapes and masses with a number each; nothing is simulated.
struct Made {
  Campaign campaign;
  std::vector<double> energy;
};

MeasuredBlock a_block(Numbers& numbers, std::size_t i) {
  MeasuredBlock b;
  b.id = "b" + std::to_string(i);
  b.stream = stream_of_name(b.id);
  b.mass = std::exp(numbers.uniform(5.0, 8.0));
  b.axes = {numbers.uniform(1.3, 2.0), numbers.uniform(1.0, 1.3), numbers.uniform(0.7, 1.0)};
  return b;
}

/// Energy is normal with a standard deviation of 2.6. The heavier blocks are at the second site, where all go further.
Made null_campaign(Numbers& numbers, std::size_t n) {
  Made made;
  for (std::size_t i = 0; i < n; ++i) {
    made.campaign.blocks.push_back(a_block(numbers, i));
    MeasuredBlock& b = made.campaign.blocks.back();
    const bool second = std::log(b.mass) + 0.5 * numbers.normal() > 6.5;
    b.group = second ? "gully" : "face";
    b.day = 1 + static_cast<int>(i % 3);
    made.energy.push_back(2.6 * numbers.normal() + (second ? 3.0 : 0.0));
  }
  return made;
}

/// Some rocks, each released several times from one place each, with a character of its own that no property explains.
Made few_rocks(Numbers& numbers, std::size_t rocks, std::size_t times) {
  Made made;
  for (std::size_t r = 0; r < rocks; ++r) {
    const MeasuredBlock rock = a_block(numbers, r);
    const double own = numbers.normal();
    for (std::size_t t = 0; t < times; ++t) {
      made.campaign.blocks.push_back(rock);
      made.campaign.blocks.back().id = "r" + std::to_string(r) + "-" + std::to_string(t);
      made.campaign.blocks.back().stream = stream_of_name(made.campaign.blocks.back().id);
      made.campaign.blocks.back().group = "rock " + std::to_string(r);
      made.energy.push_back(own + numbers.normal());
    }
  }
  return made;
}

DiagnosisRules quick() {
  DiagnosisRules rules;
  rules.arrangements = 400;
  return rules;
}

/// Of 400 null campaigns 5 % should be below 0.05; five standard errors.
void expect_size(int alarms) {
  EXPECT_NEAR(alarms / 400.0, 0.05, 5.0 * std::sqrt(0.05 * 0.95 / 400.0));
}

TEST(PropertyTest, HasItsSizeWithAWrongScatterAndAtSitesThatDiffer) {
  Numbers numbers(21);
  int alarms = 0, alarms_of_days = 0;
  for (int set = 0; set < 400; ++set) {
    const Made made = null_campaign(numbers, 48);
    const PropertyTest test = property_test(made.campaign, made.energy, quick(), 1);
    ASSERT_EQ(test.sites, 2U);
    alarms += test.regression.permuted.p_value <= 0.05;
    alarms_of_days += day_test(made.campaign, made.energy, quick(), 1).regression.permuted.p_value <= 0.05;
  }
  expect_size(alarms);
  expect_size(alarms_of_days);
}

TEST(PropertyTest, OfRocksThatWereReleasedOftenTheRocksChangePlaces) {
  Numbers numbers(22);
  int alarms = 0;
  for (int set = 0; set < 400; ++set) {
    const Made made = few_rocks(numbers, 12, 6);
    const PropertyTest test = property_test(made.campaign, made.energy, quick(), 1);
    ASSERT_TRUE(test.by_rock);
    ASSERT_EQ(test.sites, 1U) << "each group is one rock: no intercept of its own";
    alarms += test.regression.permuted.p_value <= 0.05;
  }
  expect_size(alarms);
}

TEST(PropertyTest, OfThreeRocksNoPIsBelowOneInSix) {
  Numbers numbers(23);
  Made made = few_rocks(numbers, 3, 20);
  for (std::size_t i = 0; i < 60; ++i) made.energy[i] = 10.0 * std::log(made.campaign.blocks[i].mass);
  const PropertyTest test = property_test(made.campaign, made.energy, {}, 1);
  EXPECT_EQ(test.rocks, 3U);
  EXPECT_EQ(test.regression.permuted.arrangements, 6U);
  EXPECT_GE(test.regression.permuted.p_value, 1.0 / 6.0);
}

TEST(PropertyTest, FindsShapeAndSaysItsSign) {
  Numbers numbers(24);
  Made made = null_campaign(numbers, 60);
  for (std::size_t i = 0; i < 60; ++i) {
    const MeasuredBlock& b = made.campaign.blocks[i];
    made.energy[i] -= 20.0 * std::log(b.axes.x() / b.axes.y());
  }
  const PropertyTest test = property_test(made.campaign, made.energy, {}, 1);
  EXPECT_LT(test.regression.permuted.p_value, 0.001);
  EXPECT_LT(test.slopes[0].correlation, -0.4);
  EXPECT_LT(test.slopes[0].p_value, 0.001);
  EXPECT_GT(test.slopes[2].p_value, 0.001);
}

TEST(DayTest, FindsADayWithinGroupsAndNotTheGroupsThemselves) {
  Numbers numbers(25);
  Made made = null_campaign(numbers, 60);
  for (std::size_t i = 0; i < 60; ++i)
    if (made.campaign.blocks[i].day == 2) made.energy[i] -= 5.0;
  const DayTest test = day_test(made.campaign, made.energy, {}, 1);
  EXPECT_LT(test.regression.permuted.p_value, 0.001);
  ASSERT_EQ(test.days, (std::vector<int>{1, 2, 3}));
  EXPECT_LT(test.means[1], std::min(test.means[0], test.means[2]) - 2.0);
  for (MeasuredBlock& b : made.campaign.blocks) b.day = b.group == "face" ? 1 : 2;  // a day is a site: nothing to learn
  EXPECT_FALSE(day_test(made.campaign, made.energy, {}, 1).tested);
  for (MeasuredBlock& b : made.campaign.blocks) b.day = 0;
  EXPECT_FALSE(day_test(made.campaign, made.energy, {}, 1).tested);
}

/// Neither the order of the rows nor rows that are not used change a bit.
TEST(PropertyTest, HangsNeitherOnTheOrderNorOnRowsThatAreNotUsed) {
  Numbers numbers(26);
  const Made made = null_campaign(numbers, 40);
  Made other;
  for (std::size_t i = 40; i-- > 0;) {
    other.campaign.blocks.push_back(made.campaign.blocks[i]);
    other.energy.push_back(made.energy[i]);
    other.campaign.blocks.push_back(a_block(numbers, 100 + i));
    other.energy.push_back(kNotGiven);
  }
  const PropertyTest one = property_test(made.campaign, made.energy, quick(), 1);
  const PropertyTest two = property_test(other.campaign, other.energy, quick(), 1);
  EXPECT_EQ(one.regression.permuted.p_value, two.regression.permuted.p_value);
  EXPECT_EQ(one.regression.explained, two.regression.explained);
  EXPECT_EQ(one.slopes[0].correlation, two.slopes[0].correlation);
  EXPECT_EQ(day_test(made.campaign, made.energy, quick(), 1).regression.permuted.p_value,
            day_test(other.campaign, other.energy, quick(), 1).regression.permuted.p_value);
}

}  // namespace
}  // namespace talus::test
