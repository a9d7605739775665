#include "talus/products/weibull.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "products/beta_draw.hpp"
#include "support/scenes.hpp"

namespace talus {
namespace {

/// Values drawn by the inverse of the distribution, with random numbers that are not the engine's.
std::vector<double> drawn(const Weibull& law, std::size_t n, test::Numbers& numbers) {
  std::vector<double> values(n);
  for (double& x : values) x = law.scale * std::pow(-std::log1p(-numbers.uniform(0.0, 1.0)), 1.0 / law.shape);
  return values;
}

TEST(Weibull, IsTheExponentialDistributionAtShapeOne) {
  EXPECT_DOUBLE_EQ((Weibull{1.0, 2.0}.exceedance(3.0)), std::exp(-1.5));
  EXPECT_EQ((Weibull{2.5, 2.0}.exceedance(0.0)), 1.0);
  EXPECT_EQ((Weibull{2.5, 2.0}.exceedance(-1.0)), 1.0);
}

/// Failure times with the published fit: Lawless (1982), Statistical Models and Methods for Lifetime Data, 23 ball
/// bearings in millions of revolutions; shape 2.102, scale 81.88.
TEST(WeibullFit, BallBearings) {
  const std::vector<double> revolutions{17.88, 28.92, 33.00,  41.52,  42.12,  45.60,  48.48, 51.84,
                                        51.96, 54.12, 55.56,  67.80,  68.64,  68.64,  68.88, 84.12,
                                        93.12, 98.64, 105.12, 105.84, 127.92, 128.04, 173.40};
  const Weibull law = fit_weibull(revolutions);
  EXPECT_NEAR(law.shape, 2.102, 0.001);
  EXPECT_NEAR(law.scale, 81.88, 0.01);
}

TEST(WeibullFit, ChangesWithTheUnitAsTheValuesDo) {
  test::Numbers numbers(3);
  std::vector<double> metres = drawn({1.3, 1.5}, 40, numbers), far = metres;
  for (double& x : far) x *= 1e200;
  const Weibull a = fit_weibull(metres), b = fit_weibull(far);
  EXPECT_NEAR(b.shape / a.shape, 1.0, 1e-10);
  EXPECT_NEAR(b.scale / a.scale, 1e200, 1e190);
}

/// The intervals cover the truth in 95 % of 400 data sets, within 3 standard errors of a binomial number (3.3 %). The
/// law is that of the jumps in the paper's Table 4; 30 values, where the plain percentile bootstrap covers 90 %.
TEST(WeibullFit, IntervalsCoverTheTruthAtTheStatedRate) {
  const Weibull truth{1.29, 1.44};
  constexpr int kSets = 400;
  const double limit = 4.02;
  test::Numbers numbers(20);
  int shape = 0, scale = 0, tail = 0, accepted = 0;
  for (int set = 0; set < kSets; ++set) {
    const std::vector<double> values = drawn(truth, 30, numbers);
    const WeibullFit fit = fit_weibull(values, {500, static_cast<std::uint64_t>(set)});
    const auto holds = [](const Interval& i, double value) { return i.low <= value && value <= i.high ? 1 : 0; };
    shape += holds(fit.shape, truth.shape);
    scale += holds(fit.scale, truth.scale);
    tail += holds(exceedance(fit, values, limit).fitted_bounds, truth.exceedance(limit));
    accepted += fit.accepted() ? 1 : 0;
  }
  const double expected = 0.95 * kSets, error = std::sqrt(kSets * 0.95 * 0.05);
  EXPECT_NEAR(shape, expected, 3.0 * error);
  EXPECT_NEAR(scale, expected, 3.0 * error);
  EXPECT_NEAR(tail, expected, 3.0 * error);
  EXPECT_NEAR(accepted, expected, 3.0 * error);  // the 5 % point of the Anderson-Darling distance
}

/// The known asymptotic standard errors: of the shape 0.7797 k / sqrt(n), of ln scale 1.053 / (k sqrt(n)).
/// Source: Johnson, Kotz & Balakrishnan, ch. 21. Beyond 2000 values the intervals shrink with the root of n.
TEST(WeibullFit, IntervalsOfManyValuesAreTheAsymptoticOnes) {
  test::Numbers numbers(5);
  for (const std::size_t n : {std::size_t{1500}, std::size_t{20000}}) {
    const WeibullFit fit = fit_weibull(drawn({1.5, 2.0}, n, numbers), {1000, 1});
    const double root = std::sqrt(static_cast<double>(n));
    EXPECT_NEAR((fit.shape.high - fit.shape.low) / (2 * 1.96 * 0.7797 * fit.law.shape / root), 1.0, 0.08);
    EXPECT_NEAR(std::log(fit.scale.high / fit.scale.low) / (2 * 1.96 * 1.053 / fit.law.shape / root), 1.0, 0.08);
  }
}

TEST(WeibullFit, OtherValuesAreNotTakenForWeibull) {
  test::Numbers numbers(6);
  std::vector<double> two_kinds = drawn({8.0, 1.0}, 100, numbers), far = drawn({8.0, 10.0}, 100, numbers);
  two_kinds.insert(two_kinds.end(), far.begin(), far.end());
  EXPECT_FALSE(fit_weibull(two_kinds, {10, 1}).accepted());
}

/// A quarter of zeros: the others keep their law, and the chance of an exceedance falls by a quarter.
TEST(WeibullFit, ZerosAreBlocksThatSlide) {
  test::Numbers numbers(7);
  std::vector<double> values = drawn({1.3, 1.5}, 60, numbers);
  const WeibullFit without = fit_weibull(values, {100, 1});
  const Exceedance jumped = exceedance(without, values, 2.0);
  values.insert(values.begin(), 20, 0.0);
  const WeibullFit with = fit_weibull(values, {100, 1});
  const Exceedance all = exceedance(with, values, 2.0);
  EXPECT_EQ(with.zeros, 20U);
  EXPECT_EQ(with.law.shape, without.law.shape);
  EXPECT_DOUBLE_EQ(all.fitted, 0.75 * jumped.fitted);
  EXPECT_DOUBLE_EQ(all.observed, 0.75 * jumped.observed);
}

/// The share of 1000 data sets whose interval holds the chance that a limit is exceeded.
///
/// @param n         values, of which `zeros` are 0 with this probability
/// @param quantile  of the others, at which the limit is
double share_covered(std::size_t n, double zeros, double quantile, std::uint64_t seed) {
  constexpr int kSets = 1000;
  const Weibull law{1.3, 1.0};
  const double limit = std::pow(-std::log1p(-quantile), 1.0 / law.shape), truth = (1.0 - zeros) * (1.0 - quantile);
  test::Numbers numbers(seed);
  int covered = 0;
  for (int set = 0; set < kSets; ++set) {
    std::vector<double> values = drawn(law, n, numbers);
    for (double& x : values)
      if (numbers.uniform(0.0, 1.0) < zeros) x = 0.0;
    const WeibullFit fit = fit_weibull(values, {500, 1000 * seed + static_cast<std::uint64_t>(set)});
    const Interval bounds = exceedance(fit, values, limit).fitted_bounds;
    if (bounds.low <= truth && truth <= bounds.high) ++covered;
  }
  return static_cast<double>(covered) / kSets;
}

/// 95 % within 3.5 standard errors of a binomial number (2.4 %). With the share of zeros taken as seen, 47 % held the
/// truth at P10 and 86 % at P50 with 50 values and half of them 0.
TEST(WeibullFit, IntervalsCoverTheTruthWithZerosToo) {
  constexpr struct {
    std::size_t values;
    double zeros, quantile;
  } kCases[] = {{50, 0.0, 0.5}, {50, 0.02, 0.5}, {50, 0.3, 0.1}, {50, 0.3, 0.5},
                {50, 0.5, 0.1}, {50, 0.5, 0.5},  {50, 0.5, 0.9}, {200, 0.5, 0.5}};
  std::uint64_t seed = 31;
  for (const auto& c : kCases) {
    const double share = share_covered(c.values, c.zeros, c.quantile, seed++);
    std::printf("coverage of %zu values, %.0f %% of them 0, at P%.0f of the others: %.1f %%\n", c.values,
                100.0 * c.zeros, 100.0 * c.quantile, 100.0 * share);
    EXPECT_NEAR(share, 0.95, 3.5 * std::sqrt(0.95 * 0.05 / 1000)) << c.values << " " << c.zeros << " " << c.quantile;
  }
}

/// Mean a / (a + b) and variance a b / ((a + b)^2 (a + b + 1)) of Beta(a, b), within 4 standard errors.
TEST(BetaDraw, HasTheMomentsOfItsDistribution) {
  constexpr std::array<std::array<double, 2>, 3> kShapes{{{10.5, 1.5}, {25.5, 25.5}, {10351.5, 3.5}}};
  constexpr std::uint32_t kDraws = 20000;
  for (const auto [a, b] : kShapes) {
    double sum = 0.0, squares = 0.0, fourth = 0.0;
    const double mean = a / (a + b), variance = mean * (1.0 - mean) / (a + b + 1.0);
    for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
      const double away = (beta_draw(Random(5, 1, draw, Purpose::Bootstrap), a, b) - mean) / std::sqrt(variance);
      sum += away / kDraws;
      squares += away * away / kDraws;
      fourth += away * away * away * away / kDraws;
    }
    EXPECT_NEAR(sum, 0.0, 4.0 / std::sqrt(kDraws)) << a;
    EXPECT_NEAR(squares, 1.0, 4.0 * std::sqrt((fourth - 1.0) / kDraws)) << a;
  }
}

/// 3/4 of 4000 values are above 0 and all of these above the limit: what is left is the share, whose interval is
/// that of Beta(m + 1/2, n - m + 1/2), which is normal for many values.
TEST(WeibullFit, FarBelowTheValuesTheIntervalIsThatOfTheShare) {
  test::Numbers numbers(32);
  std::vector<double> values = drawn({1.3, 1.5}, 3000, numbers);
  values.insert(values.end(), 1000, 0.0);
  const Interval share = exceedance(fit_weibull(values, {2000, 1}), values, 1e-9).fitted_bounds;
  const double error = std::sqrt(0.75 * 0.25 / 4000);
  EXPECT_NEAR(share.low, 0.75 - 1.96 * error, 0.2 * error);
  EXPECT_NEAR(share.high, 0.75 + 1.96 * error, 0.2 * error);
}

TEST(WeibullFit, TheSameSeedGivesTheSameBits) {
  test::Numbers numbers(8);
  std::vector<double> values = drawn({1.3, 1.5}, 50, numbers);
  values.insert(values.end(), 20, 0.0);
  const WeibullFit a = fit_weibull(values, {50, 4}), b = fit_weibull(values, {50, 4});
  EXPECT_EQ(a.shape.low, b.shape.low);
  EXPECT_EQ(exceedance(a, values, 1.0).fitted_bounds.low, exceedance(b, values, 1.0).fitted_bounds.low);
  EXPECT_NE(a.shape.low, (fit_weibull(values, {50, 5}).shape.low));
}

/// Nothing above the limit in 60 values: the empirical bound is the closed form 1 - 0.025^(1/60).
TEST(Exceedance, SaysTheObservedShareToo) {
  test::Numbers numbers(9);
  const std::vector<double> values = drawn({2.0, 1.0}, 60, numbers);
  const Exceedance e = exceedance(fit_weibull(values, {50, 1}), values, 100.0);
  EXPECT_EQ(e.observed, 0.0);
  EXPECT_EQ(e.observed_bounds.low, 0.0);
  EXPECT_NEAR(e.observed_bounds.high, 1.0 - std::pow(0.025, 1.0 / 60.0), 1e-12);
  EXPECT_LT(e.fitted, 1e-100);
}

}  // namespace
}  // namespace talus
