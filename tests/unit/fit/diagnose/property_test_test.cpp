#include "talus/fit/diagnose/property_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <cmath>
#include <functional>

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

/// Releases of rocks: each so many times at each of some sites, with a character of its own of variance `share`, sites
/// that differ, and a rest that makes it up to 1.
struct Design {
  std::vector<std::vector<int>> times;  // by rock, by site
  double share = 0.0, slope = 0.0;      // of log L1/L2
  bool grouped = true;
  double jitter = 0.0;  // of the mass of each release, relative
};

Made made_by(const Design& design, Numbers& numbers) {
  Made made;
  for (std::size_t r = 0; r < design.times.size(); ++r) {
    MeasuredBlock rock = a_block(numbers, r);
    const double own = std::sqrt(design.share) * numbers.normal();
    for (std::size_t s = 0; s < design.times[r].size(); ++s)
      for (int t = 0; t < design.times[r][s]; ++t) {
        MeasuredBlock& b = made.campaign.blocks.emplace_back(rock);
        b.id += "-" + std::to_string(s) + "-" + std::to_string(t);
        b.stream = stream_of_name(b.id);
        if (design.grouped) b.group = std::to_string(s);
        b.mass *= 1.0 + design.jitter * numbers.normal();
        made.energy.push_back(own + std::sqrt(1.0 - design.share) * numbers.normal() + 3.0 * static_cast<double>(s) +
                              design.slope * std::log(b.axes.x() / b.axes.y()));
      }
  }
  return made;
}

int alarms_of(const Design& design, int sets, std::uint64_t seed) {
  Numbers numbers(seed);
  int alarms = 0;
  for (int set = 0; set < sets; ++set) {
    const Made made = made_by(design, numbers);
    alarms += property_test(made.campaign, made.energy, quick(), 1).regression.permuted.p_value <= 0.05;
  }
  return alarms;
}

/// Exchanging the releases gave 16 % with eleven rocks released twice, and 23 % with one that was released twelve
/// times.
TEST(PropertyTest, HasItsSizeWhereSomeRocksWereReleasedTwice) {
  std::vector<std::vector<int>> most(11, {2}), one(12, {1});
  most.insert(most.end(), 2, {1});
  one.push_back({12});
  for (const double share : {0.25, 0.5}) {
    const int twice = alarms_of({most, share}, 400, 51), often = alarms_of({one, share}, 400, 52);
    std::printf("share of the rock %.2f: size %.1f %% (eleven released twice), %.1f %% (one released twelve times)\n",
                share, twice / 4.0, often / 4.0);
    expect_size(twice);
    expect_size(often);
  }
}

/// Three rocks that were released once are heavier than nine that were released eight times, by e^2. The means of their
/// releases scatter more: exchanging all rocks gave 13.1 %.
TEST(PropertyTest, HasItsSizeWhereRocksWereReleasedMoreOrLessOften) {
  Numbers numbers(57);
  std::vector<std::vector<int>> times(9, {8});
  times.insert(times.end(), 3, {1});
  int alarms = 0;
  for (int set = 0; set < 400; ++set) {
    Made made = made_by({times}, numbers);
    for (std::size_t i = 0; i < made.energy.size(); ++i)
      made.campaign.blocks[i].mass = std::exp(std::log(made.campaign.blocks[i].mass) / 3.0 + (i < 72 ? 0.0 : 2.0));
    alarms += property_test(made.campaign, made.energy, quick(), 1).regression.permuted.p_value <= 0.05;
  }
  std::printf("nine rocks eight times, three heavier ones once: size %.1f %%\n", alarms / 4.0);
  expect_size(alarms);
}

/// Three rocks that are weighed again for each release, with an error of 0.3 %, and no group: 81 % where each weighing
/// makes a rock.
TEST(PropertyTest, KnowsARockThatWasWeighedAgain) {
  Numbers numbers(53);
  for (int set = 0; set < 20; ++set) {
    const Made made = made_by({{{17}, {17}, {16}}, 0.5, 0.0, false, 0.003}, numbers);
    const PropertyTest test = property_test(made.campaign, made.energy, quick(), 1);
    ASSERT_EQ(test.rocks, 3U);
    ASSERT_GE(test.regression.permuted.p_value, 1.0 / 6.0);
  }
}

/// Rocks that were released at both of two sites, one to five times at each, others at one of them.
TEST(PropertyTest, HasItsSizeWhereRocksWereReleasedAtSeveralSites) {
  std::vector<std::vector<int>> times;
  for (int r = 0; r < 10; ++r) times.push_back({1 + r % 5, 1 + 3 * r % 5});
  for (int r = 0; r < 5; ++r) times.push_back({2, 0}), times.push_back({0, 3});
  expect_size(alarms_of({times, 0.25}, 400, 54));
}

/// In a chain of sites that share a rock each no two rocks can be compared. To exchange all of them would give a size
/// of 11 %.
TEST(PropertyTest, ComparesOnlyRocksOfTheSameSites) {
  std::vector<std::vector<int>> times(7, std::vector<int>(6, 0));
  for (std::size_t s = 0; s < 6; ++s) times[s][s] = times[s + 1][s] = 4;
  Numbers numbers(55);
  const Made made = made_by({times}, numbers);
  const PropertyTest test = property_test(made.campaign, made.energy, quick(), 1);
  EXPECT_EQ(test.sites, 6U);
  EXPECT_EQ(test.rocks, 7U);
  EXPECT_FALSE(test.tested);
}

/// Rocks of several sites, which differ in shape: the power is that of the F test with an intercept for each site, by
/// the noncentral F distribution; five standard errors. (Rocks that change places between sites have far less.)
TEST(PropertyTest, OfRocksAtSeveralSitesHasThePowerOfTheFTest) {
  constexpr int kSets = 200, kTimes = 4;
  for (const auto& [sites, rocks] : {std::pair<std::size_t, std::size_t>{2, 6}, {3, 5}, {4, 4}}) {
    Numbers numbers(56 + sites);
    Design design;
    design.slope = 0.7 / 0.145;  // 0.7 for a standard deviation of log L1/L2 within a site
    for (std::size_t r = 0; r < sites * rocks; ++r) {
      design.times.emplace_back(sites, 0);
      design.times.back()[r / rocks] = kTimes;
    }
    double alarms = 0.0, expected = 0.0;
    for (int set = 0; set < kSets; ++set) {
      Made made = made_by(design, numbers);
      std::vector<double> of_site(sites);
      for (double& log : of_site) log = 0.3 * numbers.normal();
      Eigen::MatrixXd x(rocks, sites);  // log L1/L2
      for (std::size_t i = 0; i < made.energy.size(); ++i) {
        MeasuredBlock& b = made.campaign.blocks[i];
        const std::size_t rock = i / kTimes, site = rock / rocks;
        x(static_cast<Eigen::Index>(rock % rocks), static_cast<Eigen::Index>(site)) = std::log(b.axes.x() / b.axes.y());
        b.axes.x() *= std::exp(of_site[site]);  // moves the site, whose intercept takes it
      }
      const Eigen::MatrixXd within = x.rowwise() - x.colwise().mean();
      const double freedom = static_cast<double>(sites * rocks - sites - 3);
      const double noncentrality = design.slope * design.slope * within.squaredNorm() * kTimes;
      const double limit = boost::math::quantile(boost::math::fisher_f(3.0, freedom), 0.95);
      expected +=
          boost::math::cdf(boost::math::complement(boost::math::non_central_f(3.0, freedom, noncentrality), limit));
      alarms += property_test(made.campaign, made.energy, quick(), 1).regression.permuted.p_value <= 0.05;
    }
    EXPECT_NEAR(alarms / kSets, expected / kSets, 5.0 * std::sqrt(0.25 / kSets)) << sites << " sites";
    std::printf("%zu sites of %zu rocks: power %.0f %%, F test %.0f %%\n", sites, rocks, 100.0 * alarms / kSets,
                100.0 * expected / kSets);
  }
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

int alarms_of_days(const Design& design, const std::function<int(std::size_t rock, std::size_t release)>& day) {
  Numbers numbers(58);
  int alarms = 0;
  for (int set = 0; set < 400; ++set) {
    Made made = made_by(design, numbers);
    std::size_t i = 0;
    for (std::size_t rock = 0; rock < design.times.size(); ++rock)
      for (std::size_t release = 0; release < static_cast<std::size_t>(design.times[rock].front()); ++release)
        made.campaign.blocks[i++].day = day(rock, release);
    const DayTest test = day_test(made.campaign, made.energy, quick(), 1);
    EXPECT_TRUE(test.tested && test.by_rock);
    alarms += test.regression.permuted.p_value <= 0.05;
  }
  return alarms;
}

/// Twelve rocks with a quarter of the variance, four releases each: all on one day of four, where exchanging releases
/// gave 25.6 %; on two days each; and half of the rocks on one day, the others on two.
TEST(DayTest, HasItsSizeWhereRocksWereReleasedAgain) {
  const Design design{std::vector<std::vector<int>>(12, {4}), 0.25};
  const auto one = [](std::size_t rock, std::size_t) { return 1 + static_cast<int>(rock % 4); };
  const auto two = [](std::size_t rock, std::size_t release) { return 1 + static_cast<int>((rock + release % 2) % 4); };
  const auto some = [&](std::size_t rock, std::size_t release) { return rock < 6 ? one(rock, 0) : two(rock, release); };
  const int of_one = alarms_of_days(design, one), of_two = alarms_of_days(design, two),
            mixed = alarms_of_days(design, some);
  std::printf("rocks of one day: size %.1f %%, of two: %.1f %%, half of them: %.1f %%\n", of_one / 4.0, of_two / 4.0,
              mixed / 4.0);
  expect_size(of_one);
  expect_size(of_two);
  expect_size(mixed);
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
