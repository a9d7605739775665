#include "talus/fit/score/score.hpp"

#include <algorithm>
#include <numeric>

#include "support/campaigns.hpp"
#include "talus/fit/score/bootstrap.hpp"
#include "talus/fit/score/fair_scores.hpp"
#include "talus/fit/score/intervals.hpp"

namespace talus::test {
namespace {

/// The CRPS by its definition, the integral of (F - 1{y <= x})^2, of the empirical distribution of n values. The fair
/// score differs from it by the mean distance of the values over 2 (n - 1) (Ferro 2014, Eq. 4 against Eq. 2).
double crps_by_integral(std::vector<double> x, double y) {
  const double n = static_cast<double>(x.size());
  double gini = 0.0;
  for (const double a : x)
    for (const double b : x) gini += std::abs(a - b);
  std::vector<double> breaks = x;
  breaks.push_back(y);
  std::sort(breaks.begin(), breaks.end());
  double integral = 0.0;
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const double middle = 0.5 * (breaks[i - 1] + breaks[i]);
    const double below = static_cast<double>(std::count_if(x.begin(), x.end(), [&](double v) { return v <= middle; }));
    const double step = below / n - (y <= middle ? 1.0 : 0.0);
    integral += step * step * (breaks[i] - breaks[i - 1]);
  }
  return integral - gini / (2.0 * n * n * (n - 1.0));
}

TEST(FairCrps, IsTheIntegralOfTheSquaredDifferenceOfTheDistributions) {
  Numbers numbers(3);
  for (const std::size_t n : {2U, 3U, 10U, 57U}) {
    std::vector<double> x(n);
    for (double& v : x) v = 10.0 * numbers.normal();
    if (n > 5) x[3] = x[4];  // ties
    for (const double y : {-40.0, 0.0, 3.0, x[1], 50.0}) {
      const double expected = crps_by_integral(x, y);
      std::vector<double> copy = x;
      EXPECT_NEAR(fair_crps(copy, y), expected, 1e-12 * 50.0) << n << ' ' << y;
    }
  }
}

/// For a standard normal forecast the CRPS at y is y (2 Phi(y) - 1) + 2 phi(y) - 1/sqrt(pi) (Gneiting & Raftery 2007).
TEST(FairCrps, OfANormalForecast) {
  Numbers numbers(4);
  std::vector<double> x(200000);
  for (double& v : x) v = numbers.normal();
  for (const double y : {0.0, 1.0, -2.5}) {
    const double phi = std::exp(-0.5 * y * y) / std::sqrt(2.0 * kPi), cdf = 0.5 * std::erfc(-y / std::sqrt(2.0));
    EXPECT_NEAR(fair_crps(x, y), y * (2.0 * cdf - 1.0) + 2.0 * phi - 1.0 / std::sqrt(kPi), 5.0 * 0.9 / std::sqrt(2e5));
  }
}

TEST(FairEnergyScore, OnALineIsTheCrps) {
  Numbers numbers(5);
  std::vector<double> x(40);
  std::vector<Eigen::Vector2d> places;
  const Eigen::Vector2d direction(0.6, 0.8), origin(100.0, -30.0);
  for (double& v : x) places.push_back(origin + (v = 7.0 * numbers.normal()) * direction);
  EXPECT_NEAR(fair_energy_score(places, origin + 4.0 * direction), fair_crps(x, 4.0), 1e-12 * 100.0);
}

/// The estimate is unbiased: two values on average give what two hundred give.
TEST(FairCrps, DoesNotDependOnTheNumberOfValuesOnAverage) {
  Numbers numbers(6);
  Moments few, many;
  for (int k = 0; k < 20000; ++k) {
    std::vector<double> two{numbers.normal(), numbers.normal()};
    few.add(fair_crps(two, 0.7));
  }
  for (int k = 0; k < 300; ++k) {
    std::vector<double> lot(200);
    for (double& v : lot) v = numbers.normal();
    many.add(fair_crps(lot, 0.7));
  }
  EXPECT_NEAR(few.mean(), many.mean(), 5.0 * std::hypot(few.error(), many.error()));
}

/// A small campaign and simulated values, scored group by group in another form.
class Scores : public testing::Test {
 protected:
  Scores() : campaign_(campaign_on_slope(24)), runs_(24) {
    Numbers numbers(8);
    for (std::size_t b = 0; b < 24; ++b) {
      MeasuredBlock& block = campaign_.blocks[b];
      block.stop = Eigen::Vector2d(numbers.uniform(100, 140), numbers.uniform(30, 100));
      block.samples = {{0, 0, 0, 20.0, numbers.uniform(5, 10), kNotGiven},
                       {0, 0, 0, 50.0, numbers.uniform(5, 10), 3.0}};
      if (b % 2 == 0) block.passages[0] = Passage{numbers.uniform(5, 15), b % 4 == 0 ? kNotGiven : 1.0 + 0.1 * b, 9.0};
      BlockRuns& r = runs_[b];
      r.trials = 20;
      r.mass_share.assign(20, 1.0);
      r.screens.resize(1);
      r.samples.resize(2);
      for (int t = 0; t < 20; ++t) {
        const bool stopped = b != 4 || t < 9, crossed = t % 3 != 0;  // block 4: too few stops
        r.x.push_back(stopped ? numbers.uniform(100, 140) : kNotGiven);
        r.y.push_back(stopped ? numbers.uniform(30, 100) : kNotGiven);
        r.screens[0].speed.push_back(crossed ? numbers.uniform(5, 15) : kNotGiven);
        r.screens[0].jump.push_back(crossed ? numbers.uniform(0, 3) : kNotGiven);
        r.screens[0].spin.push_back(crossed ? numbers.uniform(0, 20) : kNotGiven);
        for (auto& s : r.samples) {
          s.speed.push_back(numbers.uniform(5, 10));
          s.spin.push_back(numbers.uniform(0, 9));
        }
      }
    }
  }

  double group(const Score& s, const std::string& name, std::uint32_t rows) const {
    for (const GroupScore& g : s.groups)
      if (g.name == name) {
        EXPECT_EQ(g.rows, rows) << name;
        return g.score;
      }
    ADD_FAILURE() << "no group " << name;
    return kNotGiven;
  }

  static double spread(const std::vector<double>& v) {
    double mean = 0.0, square = 0.0;
    for (const double x : v) mean += x / static_cast<double>(v.size());
    for (const double x : v) square += (x - mean) * (x - mean) / static_cast<double>(v.size());
    return std::sqrt(square);
  }

  Campaign campaign_;
  std::vector<BlockRuns> runs_;
};

TEST_F(Scores, SpeedAtTheScreen) {
  std::vector<double> fitting;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (!b.holdout && b.passages[0]) fitting.push_back(b.passages[0]->speed);
  double sum = 0.0;
  int rows = 0;
  for (std::size_t b = 0; b < 24; ++b) {
    if (!campaign_.blocks[b].holdout || !campaign_.blocks[b].passages[0]) continue;
    std::vector<double> x;
    for (const double v : runs_[b].screens[0].speed)
      if (!std::isnan(v)) x.push_back(v);
    sum += crps_by_integral(x, campaign_.blocks[b].passages[0]->speed);
    ++rows;
  }
  ASSERT_EQ(rows, 4);  // fewer than five: no group
  for (const GroupScore& g : score(campaign_, runs_, holdout_rows(campaign_)).groups) EXPECT_NE(g.name, "speed S1");
  sum = 0.0, rows = 0;
  for (std::size_t b = 0; b < 24; ++b) {
    if (campaign_.blocks[b].holdout || !campaign_.blocks[b].passages[0]) continue;
    std::vector<double> x;
    for (const double v : runs_[b].screens[0].speed)
      if (!std::isnan(v)) x.push_back(v);
    sum += crps_by_integral(x, campaign_.blocks[b].passages[0]->speed);
    ++rows;
  }
  const Score s = score(campaign_, runs_, fitting_rows(campaign_));
  EXPECT_NEAR(group(s, "speed S1", 8), sum / rows / spread(fitting), 1e-12);
}

TEST_F(Scores, MissingValuesDropTheRowOfTheirQuantityOnly) {
  const Score s = score(campaign_, runs_, fitting_rows(campaign_));
  for (const GroupScore& g : s.groups) EXPECT_NE(g.name, "jump S1");  // four of eight measured: fewer than five
  for (const GroupScore& g : s.groups) EXPECT_NE(g.name, "spin S1");  // all equal: no spread to compare with
}

TEST_F(Scores, CrossedIsABrierScore) {
  double sum = 0.0;
  for (std::size_t b = 0; b < 24; ++b) {
    if (campaign_.blocks[b].holdout) continue;
    std::vector<double> trials;  // 13 ones, 7 zeros: the Brier score is their CRPS
    for (int t = 0; t < 20; ++t) trials.push_back(t % 3 != 0 ? 1.0 : 0.0);
    sum += crps_by_integral(trials, b % 2 == 0 ? 1.0 : 0.0);
  }
  EXPECT_NEAR(group(score(campaign_, runs_, fitting_rows(campaign_)), "crossed S1", 16), sum / 16.0 / 0.25, 1e-12);
}

TEST_F(Scores, ARowWithFewValuesScoresAsTheClimatology) {
  std::vector<Eigen::Vector2d> fitting;
  std::vector<double> x, y;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (!b.holdout) fitting.push_back(*b.stop), x.push_back(b.stop->x()), y.push_back(b.stop->y());
  const Score s = score(campaign_, runs_, fitting_rows(campaign_));
  ASSERT_EQ(s.groups[0].name, "stop");
  EXPECT_EQ(s.groups[0].unseen, 1U);
  for (const RowScore& row : s.rows) {
    if (row.group != 0) continue;
    EXPECT_EQ(row.unseen, row.block == 4);
    if (row.block == 4) {
      EXPECT_NEAR(row.score, fair_energy_score(fitting, *campaign_.blocks[4].stop) / std::hypot(spread(x), spread(y)),
                  1e-12);
    }
  }
}

TEST_F(Scores, WhatASearchCutsShortRaisesTheRowsOfItsBlock) {
  const Score whole = score(campaign_, runs_, fitting_rows(campaign_));
  EXPECT_EQ(whole.cut_short, 0.0);
  runs_[6].cut_short = 5;
  const Score cut = score(campaign_, runs_, fitting_rows(campaign_));
  EXPECT_DOUBLE_EQ(cut.cut_short, 5.0 / 20.0 / 16.0);
  ASSERT_EQ(cut.rows.size(), whole.rows.size());
  for (std::size_t r = 0; r < cut.rows.size(); ++r)
    EXPECT_NEAR(cut.rows[r].score - whole.rows[r].score, cut.rows[r].block == 6 ? 4.0 * 5.0 / 20.0 : 0.0, 1e-12);
}

/// In what a fit minimises a block that has come to rest is not explained by trials that leave the map: without stops
/// its row scores as the climatology, which is better than many a model.
TEST_F(Scores, AFitGainsNothingBySendingBlocksOffTheMap) {
  const std::vector<bool> rows = fitting_rows(campaign_);
  const Score before = score(campaign_, runs_, rows, fit_scoring());
  for (const auto& [left, rise] : {std::pair{10U, 0.0}, {15U, 2.0}, {20U, 4.0}}) {  // of 20 trials
    std::vector<BlockRuns> runs = runs_;
    runs[6].ends[static_cast<std::size_t>(End::Left)] = left;
    const Score after = score(campaign_, runs, rows, fit_scoring());
    for (std::size_t r = 0; r < after.rows.size(); ++r) {
      const bool stop = after.groups[after.rows[r].group].name == "stop" && after.rows[r].block == 6;
      EXPECT_NEAR(after.rows[r].score - before.rows[r].score, stop ? rise : 0.0, 1e-12);
    }
    EXPECT_DOUBLE_EQ(score(campaign_, runs, rows).total, score(campaign_, runs_, rows).total);  // as score.py has it
  }
}

/// Trials that end in a wrong place and are cut short never make a model look better than the same trials to their end.
TEST_F(Scores, CuttingTrialsShortIsNoWayToABetterScore) {
  const std::vector<bool> rows = fitting_rows(campaign_);
  for (const double off : {0.0, 30.0, 60.0, 90.0})  // metres beyond the measured stops, of which the sd is 23 m
    for (const std::size_t cut : {1U, 4U, 10U, 20U}) {
      std::vector<BlockRuns> to_end = runs_, searched = runs_;
      for (std::size_t b = 0; b < runs_.size(); ++b) {
        searched[b].cut_short = static_cast<std::uint32_t>(cut);
        for (std::size_t t = 0; t < cut; ++t) {
          to_end[b].x[t] += off;
          searched[b].x[t] = searched[b].y[t] = kNotGiven;
          for (auto* values :
               {&searched[b].screens[0].speed, &searched[b].screens[0].jump, &searched[b].screens[0].spin})
            (*values)[t] = kNotGiven;
        }
      }
      EXPECT_GT(group(score(campaign_, searched, rows), "stop", 16), group(score(campaign_, to_end, rows), "stop", 16))
          << off << ' ' << cut;
    }
}

TEST_F(Scores, ABlockCountsOnceForAllItsSamples) {
  std::vector<double> fitting;
  double sum = 0.0;
  for (std::size_t b = 0; b < 24; ++b) {
    if (campaign_.blocks[b].holdout) continue;
    double mean = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      fitting.push_back(campaign_.blocks[b].samples[i].speed);
      mean += 0.5 * crps_by_integral(runs_[b].samples[i].speed, campaign_.blocks[b].samples[i].speed);
    }
    sum += mean;
  }
  const Score s = score(campaign_, runs_, fitting_rows(campaign_));
  EXPECT_NEAR(group(s, "sample speed", 16), sum / 16.0 / spread(fitting), 1e-12);
}

TEST_F(Scores, MassOnlyWhereBlocksBroke) {
  const auto has_mass = [&] {
    const Score s = score(campaign_, runs_, fitting_rows(campaign_));
    return std::any_of(s.groups.begin(), s.groups.end(), [](const auto& g) { return g.name == "mass"; });
  };
  for (MeasuredBlock& b : campaign_.blocks) b.stop_mass = b.mass * 0.96;
  EXPECT_FALSE(has_mass());
  for (std::size_t b = 0; b < 6; ++b) campaign_.blocks[b].stop_mass = 0.3 * campaign_.blocks[b].mass;
  EXPECT_FALSE(has_mass());  // two of the six are held out
  campaign_.blocks[6].stop_mass = 0.3 * campaign_.blocks[6].mass;
  EXPECT_TRUE(has_mass());
}

TEST_F(Scores, EqualWeightsGiveTheTotalAndTheIntervalHoldsIt) {
  const Score s = score(campaign_, runs_, fitting_rows(campaign_));
  EXPECT_NEAR(weighted_total(s, std::vector<double>(24, 2.0)), s.total, 1e-13);
  const ScoreIntervals i = score_intervals(s, clusters_of(campaign_));
  EXPECT_LT(i.total.low, s.total);
  EXPECT_GT(i.total.high, s.total);
}

/// Each fitting row against the others: on average half of the mean distance of two measurements, and of a crossing
/// that h of n blocks made h (n - h) / (n (n - 1)).
TEST_F(Scores, OfTheClimatology) {
  std::vector<double> speed;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (!b.holdout && b.passages[0]) speed.push_back(b.passages[0]->speed);
  double distance = 0.0;
  for (const double a : speed)
    for (const double b : speed) distance += std::abs(a - b) / (8.0 * 7.0);
  const Score s = score_of_climatology(campaign_, fitting_rows(campaign_));
  EXPECT_NEAR(group(s, "speed S1", 8), 0.5 * distance / spread(speed), 1e-12);
  EXPECT_NEAR(group(s, "crossed S1", 16), 8.0 * 8.0 / (16.0 * 15.0) / 0.25, 1e-12);
  const Score model = score(campaign_, runs_, fitting_rows(campaign_));
  ASSERT_EQ(model.groups.size(), s.groups.size());
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    EXPECT_EQ(model.groups[g].name, s.groups[g].name);
    EXPECT_EQ(model.groups[g].rows, s.groups[g].rows) << "on the same rows";
  }
}

/// 8 of the 16 fitting blocks crossed, and 13 of 20 trials of each. By hand: the climatology of a block that crossed is
/// 7 of 15, of another 8 of 15, not 8 of 16.
TEST_F(Scores, TheLogScoreOfACrossingMixesTheClimatologyOfTheOthers) {
  ScoreOptions log;
  log.rule = ScoreRule::LogDensity;
  const auto score_of = [](double if_crossed, double if_not) {
    return -0.5 * (std::log(if_crossed) + std::log(1.0 - if_not));
  };
  const double simulated = 0.95 * 13.5 / 21.0;
  EXPECT_NEAR(group(score(campaign_, runs_, fitting_rows(campaign_), log), "crossed S1", 16),
              score_of(simulated + 0.05 * 7.0 / 15.0, simulated + 0.05 * 8.0 / 15.0), 1e-12);
  EXPECT_NEAR(group(score_of_climatology(campaign_, fitting_rows(campaign_), log), "crossed S1", 16),
              score_of(0.95 * 7.5 / 16.0 + 0.05 * 7.0 / 15.0, 0.95 * 8.5 / 16.0 + 0.05 * 8.0 / 15.0), 1e-12);
}

/// Of a held-out row it is that of all fitting rows, which is what a row without simulated values scores.
TEST_F(Scores, OfTheClimatologyOnHeldOutRows) {
  std::vector<Eigen::Vector2d> fitting;
  std::vector<double> x, y;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (!b.holdout) fitting.push_back(*b.stop), x.push_back(b.stop->x()), y.push_back(b.stop->y());
  const Score s = score_of_climatology(campaign_, holdout_rows(campaign_));
  double sum = 0.0;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (b.holdout) sum += fair_energy_score(fitting, *b.stop);
  EXPECT_NEAR(group(s, "stop", 8), sum / 8.0 / std::hypot(spread(x), spread(y)), 1e-12);
}

/// Blocks that go the same way from releases 100 m apart: who knows the releases foretells each exactly. From one
/// release the ways tell what the places do.
TEST_F(Scores, OfTheClimatologyThatKnowsTheReleases) {
  ScoreOptions ways;
  ways.ways_from_release = true;
  for (MeasuredBlock& b : campaign_.blocks) b.x = 20.0, b.y = -5.0;
  EXPECT_NEAR(group(score_of_climatology(campaign_, holdout_rows(campaign_), ways), "stop", 8),
              group(score_of_climatology(campaign_, holdout_rows(campaign_)), "stop", 8), 1e-12);
  double x = 0.0;
  for (MeasuredBlock& b : campaign_.blocks) {
    b.x = x += 100.0;
    b.stop = Eigen::Vector2d(b.x + 30.0, b.y + 40.0);
  }
  EXPECT_NEAR(group(score_of_climatology(campaign_, holdout_rows(campaign_), ways), "stop", 8), 0.0, 1e-12);
  EXPECT_GT(group(score_of_climatology(campaign_, holdout_rows(campaign_)), "stop", 8), 0.1);
}

TEST_F(Scores, OfHeldOutBlocksDoNotDecideWhatIsFitted) {
  for (MeasuredBlock& b : campaign_.blocks) b.stop_mass = (b.holdout ? 0.3 : 0.97) * b.mass;
  for (const GroupScore& g : score(campaign_, runs_, fitting_rows(campaign_)).groups) EXPECT_NE(g.name, "mass");
  campaign_.blocks[0].stop_mass = 0.96 * campaign_.blocks[0].mass;  // a spread, though no block broke
  const Score held_out = score(campaign_, runs_, holdout_rows(campaign_));
  EXPECT_TRUE(std::ranges::any_of(held_out.groups, [](const auto& g) { return g.name == "mass"; }));
}

TEST(LargeGroups, KeepTheirRows) {
  Score s;
  s.groups = {{"few", 0.9, 9}, {"stop", 0.4, 10}, {"speed S", 0.6, 12}};
  for (std::uint32_t group = 0; group < 3; ++group)
    for (std::uint32_t row = 0; row < s.groups[group].rows; ++row)
      s.rows.push_back({group, row, s.groups[group].score});
  const Score large = of_large_groups(s);
  ASSERT_EQ(large.groups.size(), 2U);
  EXPECT_EQ(large.groups[0].name, "stop");
  EXPECT_NEAR(large.total, 0.5, 1e-12);
  EXPECT_EQ(large.rows.size(), 22U);
  EXPECT_NEAR(weighted_total(large, std::vector<double>(12, 1.0)), 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(of_large_groups(s, 13).total));
}

/// Groups of 30 and 10 rows with errors of 0.4 and 0.8 count 30/40 and 10/20: (0.3 + 0.4) / 1.25. The rows stay as they
/// are, and equal weights of the blocks give the total again.
TEST(WeighGroups, ByWhatTheirRowsTell) {
  Score s;
  s.groups = {{"stop", 0.4, 30}, {"speed S", 0.8, 10}};
  for (std::uint32_t row = 0; row < 40; ++row) s.rows.push_back({row / 30, row % 30, row < 30 ? 0.4 : 0.8});
  const Score weighed = weigh_groups(s);
  EXPECT_NEAR(weighed.total, 0.56, 1e-12);
  EXPECT_NEAR(weighted_total(weighed, std::vector<double>(30, 1.0)), 0.56, 1e-12);
  EXPECT_NEAR(weighted_total(s, std::vector<double>(30, 1.0)), 0.6, 1e-12);
  EXPECT_EQ(weighed.rows.size(), 40U);
  EXPECT_TRUE(std::isnan(weigh_groups({}).total));
}

std::vector<std::uint32_t> streams(std::uint32_t blocks) {
  std::vector<std::uint32_t> list;
  for (std::uint32_t b = 0; b < blocks; ++b) list.push_back(stream_of_name("block " + std::to_string(b)));
  return list;
}

/// Rubin (1981): the variance of the mean of n values is that of the values over n + 1, for any n. Five standard errors
/// of a variance of so many draws, with the kurtosis of the draws below 6.
TEST(Bootstrap, VarianceOfAMeanIsRubins) {
  Numbers numbers(12);
  constexpr std::uint32_t kDraws = 20'000;
  for (const std::size_t n : {5U, 24U}) {
    std::vector<double> values(n);
    for (double& v : values) v = numbers.normal();
    const Score s = score_of_rows(values);
    double variance = 0.0;
    for (const double v : values) variance += (v - s.total) * (v - s.total) / static_cast<double>(n);
    Moments draws;
    for (const double d :
         difference(score_of_rows(std::vector<double>(n, 0.0)), s, streams(static_cast<std::uint32_t>(n)), kDraws)
             .draws)
      draws.add(d);
    const double expected = variance / (static_cast<double>(n) + 1.0);
    EXPECT_NEAR(draws.mean(), s.total, 5.0 * std::sqrt(expected / kDraws)) << n;
    EXPECT_NEAR(draws.squares / draws.count - draws.mean() * draws.mean(), expected,
                5.0 * expected * std::sqrt(5.0 / kDraws))
        << n;
  }
}

/// Five orders with the same rows' scores are one order; two that cancel leave nothing, draw by draw.
TEST(MeanDifference, TakesTheSameBlocksOfEveryPair) {
  const std::vector<std::uint32_t> ids = streams(6);
  const Score zero = score_of_rows({0, 0, 0, 0, 0, 0}), up = score_of_rows({1, 2, 4, 3, 6, 5}),
              down = score_of_rows({-1, -2, -4, -3, -6, -5});
  const Difference one = difference(zero, up, ids);
  const Difference five = mean_difference(std::vector<Score>(5, zero), std::vector<Score>(5, up), ids);
  EXPECT_NEAR(five.mean, 3.5, 1e-12);
  EXPECT_NEAR(five.interval.low, one.interval.low, 1e-12);
  EXPECT_NEAR(five.interval.high, one.interval.high, 1e-12);
  const Difference none = mean_difference(std::vector<Score>{zero, zero}, std::vector<Score>{up, down}, ids);
  for (const double draw : none.draws) EXPECT_NEAR(draw, 0.0, 1e-12);
}

/// The interval of a mean is 2 t standard errors wide: t of 399 degrees of freedom is 1.965927, the textbook's
/// interval.
TEST(Intervals, WidthOfTheIntervalOfAMean) {
  Numbers numbers(12);
  std::vector<double> values(400);
  for (double& v : values) v = numbers.normal();
  const Score s = score_of_rows(values);
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  const double error = std::sqrt((squares / 400.0 - s.total * s.total) / 399.0);
  const Interval i = score_intervals(s, streams(400)).total;
  EXPECT_NEAR(i.high - i.low, 2.0 * 1.965927 * error, 1e-5 * error);
  EXPECT_NEAR(reduction(s, s, streams(400)).share, 0.0, 1e-15);
}

/// The weight of a block follows from its stream: neither its place nor another block changes it.
TEST(Bootstrap, WeightsGoByTheStream) {
  std::vector<std::uint32_t> ids = streams(5);
  const std::vector<double> before = bootstrap_weights(ids, 7, 3);
  std::ranges::reverse(ids);
  ids.push_back(99);
  const std::vector<double> after = bootstrap_weights(ids, 7, 3);
  for (std::size_t b = 0; b < 5; ++b) EXPECT_EQ(after[4 - b], before[b]);
  EXPECT_NE(bootstrap_weights(ids, 8, 3)[0], after[0]);
  EXPECT_NE(bootstrap_weights(ids, 7, 4)[0], after[0]);
}

}  // namespace
}  // namespace talus::test
