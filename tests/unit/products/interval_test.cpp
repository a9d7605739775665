#include "talus/products/interval.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace talus {
namespace {

TEST(ProbabilityBounds, PublishedTable) {  // two-sided 95 %, e.g. Geigy Scientific Tables
  struct Row {
    std::uint64_t hits, trials;
    double low, high;
  };
  for (const Row& row :
       {Row{0, 10, 0.0, 0.3085}, Row{1, 10, 0.0025, 0.4450}, Row{5, 10, 0.1871, 0.8129}, Row{9, 10, 0.5550, 0.9975},
        Row{10, 10, 0.6915, 1.0}, Row{0, 1, 0.0, 0.975}, Row{1, 1, 0.025, 1.0}}) {
    const Interval bounds = probability_bounds(row.hits, row.trials, 0.95);
    EXPECT_NEAR(bounds.low, row.low, 5e-5) << row.hits << " of " << row.trials;
    EXPECT_NEAR(bounds.high, row.high, 5e-5) << row.hits << " of " << row.trials;
  }
  EXPECT_EQ(probability_bounds(0, 10, 0.95).low, 0.0);
  EXPECT_EQ(probability_bounds(10, 10, 0.95).high, 1.0);
}

double log_choose(double n, double k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

/// P(K = k) of n trials of probability p in (0, 1).
double binomial(std::uint64_t k, std::uint64_t n, double p) {
  const auto hits = static_cast<double>(k), trials = static_cast<double>(n);
  return std::exp(log_choose(trials, hits) + hits * std::log(p) + (trials - hits) * std::log1p(-p));
}

TEST(ProbabilityBounds, TailsAreExact) {  // the definition: P(K >= k | low) = P(K <= k | high) = 2.5 %
  for (const std::uint64_t n : {1U, 7U, 50U, 1000U})
    for (const double share : {0.0, 0.1, 0.5, 0.8, 1.0}) {
      const auto k = static_cast<std::uint64_t>(share * static_cast<double>(n));
      const Interval bounds = probability_bounds(k, n, 0.95);
      double upper = 0.0, lower = 0.0;
      for (std::uint64_t i = k; k > 0 && i <= n; ++i) upper += binomial(i, n, bounds.low);
      for (std::uint64_t i = 0; k < n && i <= k; ++i) lower += binomial(i, n, bounds.high);
      EXPECT_NEAR(upper, k > 0 ? 0.025 : 0.0, 1e-9) << k << " of " << n;
      EXPECT_NEAR(lower, k < n ? 0.025 : 0.0, 1e-9) << k << " of " << n;
    }
}

TEST(ProbabilityBounds, CoverAtLeastAsOftenAsTheySay) {
  for (const double confidence : {0.8, 0.95, 0.99})
    for (const std::uint64_t n : {1U, 5U, 10U, 50U, 200U})
      for (const double p : {0.0005, 0.01, 0.1, 0.23, 0.5, 0.77, 0.95, 0.999}) {
        double covered = 0.0;
        for (std::uint64_t k = 0; k <= n; ++k) {
          const Interval bounds = probability_bounds(k, n, confidence);
          if (bounds.low <= p && p <= bounds.high) covered += binomial(k, n, p);
        }
        EXPECT_GE(covered, confidence - 1e-12) << n << ' ' << p;
      }
}

TEST(ProbabilityBounds,
     LargeNumbersOfTrials) {  // against the normal approximation, and the rule of three without a hit
  const double n = 1e9, p = 1e-3, error = std::sqrt(p * (1.0 - p) / n);
  const Interval bounds = probability_bounds(1'000'000, 1'000'000'000, 0.95);
  EXPECT_NEAR(bounds.low, p - 1.959964 * error, 0.01 * error);
  EXPECT_NEAR(bounds.high, p + 1.959964 * error, 0.01 * error);
  EXPECT_NEAR(probability_bounds(0, 1'000'000'000, 0.95).high, -std::log(0.025) / n, 1e-6 * 3.69 / n);
}

/// Share of 4000 repetitions in which the bounds hold the mean probability of the source cells that hit.
struct Coverage {
  double of_bounds, of_simple_lower_bound;
};
Coverage coverage_of_reached(int sources, std::uint64_t trials, double probability) {
  constexpr int kRepetitions = 4000;
  test::Numbers numbers(5);
  int covered = 0, simple = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::uint64_t hits = 0, reaching = 0;
    double sum = 0.0;
    for (int source = 0; source < sources; ++source) {
      const double p = probability * (source % 4 == 0 ? 2.0 : 0.5);
      std::uint64_t mine = 0;
      for (std::uint64_t i = 0; i < trials; ++i) mine += numbers.uniform(0.0, 1.0) < p ? 1 : 0;
      if (mine == 0) continue;
      hits += mine, ++reaching, sum += p;
    }
    const double truth = reaching > 0 ? sum / static_cast<double>(reaching) : 0.0;
    const Interval bounds = reaching > 0 ? bounds_of_reached(hits, reaching, trials) : Interval{0.0, 1.0};
    covered += bounds.low <= truth && truth <= bounds.high ? 1 : 0;
    simple += reaching == 0 || probability_bounds(hits, reaching * trials, 0.95).low <= truth ? 1 : 0;
  }
  return {covered / double{kRepetitions}, simple / double{kRepetitions}};
}

TEST(BoundsOfReached, CoverTheSourceCellsThatWereChosenByTheirHits) {
  for (const int sources : {1, 5, 60})
    for (const std::uint64_t trials : {1U, 10U, 100U})
      for (const double p : {0.001, 0.02, 0.4})
        EXPECT_GE(coverage_of_reached(sources, trials, p).of_bounds, 0.95 - 2.5 * std::sqrt(0.95 * 0.05 / 4000))
            << sources << ' ' << trials << ' ' << p;
  EXPECT_LT(coverage_of_reached(60, 10, 0.001).of_simple_lower_bound, 0.9) << "a bound that forgets the choice fails";
}

TEST(BoundsOfReached, ByHand) {
  EXPECT_EQ(bounds_of_reached(3, 3, 100).low, 0.0) << "the hits only say which source cells there are";
  EXPECT_EQ(bounds_of_reached(10, 1, 10).high, 1.0);
  EXPECT_NEAR(bounds_of_reached(11, 1, 11).low, 0.6915, 5e-5) << "ten of ten further trials";
  EXPECT_NEAR(bounds_of_reached(1, 1, 10).high, 0.4450, 5e-5);
}

}  // namespace
}  // namespace talus
