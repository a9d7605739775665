#include "talus/products/percentile_bounds.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "support/scenes.hpp"

namespace talus {
namespace {

TEST(PercentileRanks, PublishedTables) {  // distribution-free interval of the median, e.g. Conover, table A3; Geigy
  struct Row {
    std::uint64_t n, low, high;
  };
  for (const Row& row : {Row{5, 0, 0}, Row{6, 1, 6}, Row{8, 1, 8}, Row{9, 2, 8}, Row{10, 2, 9}, Row{15, 4, 12},
                         Row{20, 6, 15}, Row{25, 8, 18}, Row{100, 40, 61}}) {
    const Ranks ranks = percentile_ranks(row.n, 0.5);
    EXPECT_EQ(ranks.low, row.low) << row.n;
    EXPECT_EQ(ranks.high, row.high) << row.n;
  }
}

TEST(PercentileRanks, TheFirstNumberWithAnUpperBound) {  // 0.95^72 = 0.0249, 0.99^368 = 0.0248: the largest is above
  EXPECT_EQ(percentile_ranks(71, 0.95).high, 0U);
  EXPECT_EQ(percentile_ranks(72, 0.95).high, 72U);
  EXPECT_EQ(percentile_ranks(367, 0.99).high, 0U);
  EXPECT_EQ(percentile_ranks(368, 0.99).high, 368U);
  EXPECT_EQ(percentile_ranks(1, 0.95).low, 0U) << "5 % of the values lie above";
  EXPECT_EQ(percentile_ranks(2, 0.95).low, 1U);
}

/// P(B <= k), summed term by term.
double at_most(std::uint64_t k, std::uint64_t n, double p) {
  double sum = 0.0;
  for (std::uint64_t i = 0; i <= k; ++i) {
    const auto a = static_cast<double>(i), all = static_cast<double>(n);
    sum += std::exp(std::lgamma(all + 1.0) - std::lgamma(a + 1.0) - std::lgamma(all - a + 1.0) + a * std::log(p) +
                    (all - a) * std::log1p(-p));
  }
  return sum;
}

TEST(PercentileRanks, AreTheDefinition) {
  for (std::uint64_t n = 1; n <= 3000; n += n < 400 ? 1 : 13)
    for (const double share : {0.5, 0.95, 0.99}) {
      const Ranks ranks = percentile_ranks(n, share);
      if (ranks.low > 0) {
        EXPECT_LE(at_most(ranks.low - 1, n, share), 0.025);
      }
      if (ranks.low < n) {
        EXPECT_GT(at_most(ranks.low, n, share), 0.025) << "no larger rank is a bound";
      }
      const std::uint64_t high = ranks.high > 0 ? ranks.high : n + 1;
      if (ranks.high > 0) {
        EXPECT_LE(1.0 - at_most(high - 1, n, share), 0.025 + 1e-9);
      }
      EXPECT_GT(1.0 - (high >= 2 ? at_most(high - 2, n, share) : 0.0), 0.025 - 1e-9) << "no smaller rank is a bound";
    }
}

/// How often, of `kRepetitions` samples of n values, both bounds hold the true percentile.
double coverage(std::uint64_t n, double share, const std::function<double(double)>& quantile, bool strata) {
  constexpr int kRepetitions = 1000;
  test::Numbers numbers(17);
  const Ranks ranks = percentile_ranks(n, share);
  const double truth = quantile(share);
  int covered = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<float> values(n);
    float largest = 0.0F;
    for (std::size_t i = 0; i < n; ++i) {  // in strata each value is from a slice of the distribution of its own
      const double u = numbers.uniform(0.0, 1.0);
      values[i] = static_cast<float>(quantile(strata ? (static_cast<double>(i % 10) + u) / 10.0 : u));
      largest = std::max(largest, values[i]);
    }
    LogHistogram histogram;
    histogram.add(values);
    const Interval bounds = percentile_bounds(histogram, ranks, largest);
    covered += !(truth < bounds.low) && !(truth > bounds.high) ? 1 : 0;  // where there is no bound nothing is said
  }
  return static_cast<double>(covered) / kRepetitions;
}

TEST(PercentileBounds, CoverAClosedForm) {
  const std::array<std::function<double(double)>, 3> quantiles{
      [](double u) { return -100.0 * std::log1p(-u); },                 // exponential
      [](double u) { return 300.0 * std::pow(-std::log1p(-u), 0.4); },  // Weibull
      [](double u) { return 1.0 + u; },                                 // uniform: hundreds of values in one bin
  };
  const double error = std::sqrt(0.95 * 0.05 / 1000);
  for (std::size_t i = 0; i < quantiles.size(); ++i)
    for (const std::uint64_t n : {10U, 80U, 400U, 3000U})
      for (const double share : {0.5, 0.95, 0.99})
        for (const bool strata : {false, true})
          EXPECT_GE(coverage(n, share, quantiles[i], strata), 0.95 - 2.5 * error)
              << i << ' ' << n << ' ' << share << ' ' << strata;
}

TEST(PercentileBounds, AreNotMuchTooWide) {  // with many values the width is that of the order statistics and two bins
  test::Numbers numbers(3);
  std::vector<float> values(20000);
  for (float& value : values) value = static_cast<float>(-100.0 * std::log1p(-numbers.uniform(0.0, 1.0)));
  LogHistogram histogram;
  histogram.add(values);
  const Interval bounds = percentile_bounds(histogram, percentile_ranks(values.size(), 0.95), 1e9);
  const double truth = 100.0 * std::log(20.0), error = 100.0 / 0.05 * std::sqrt(0.95 * 0.05 / 20000.0);
  EXPECT_GT(bounds.low, truth - 4.0 * error - 0.0625 * truth);
  EXPECT_LT(bounds.high, truth + 4.0 * error + 0.0625 * truth);
}

TEST(PercentileBounds, WhereThereIsNone) {
  LogHistogram histogram;
  histogram.add(std::array{1.0F, 2.0F, 3.0F});
  const Interval bounds = percentile_bounds(histogram, percentile_ranks(3, 0.5), 3.0);
  EXPECT_TRUE(std::isnan(bounds.low) && std::isnan(bounds.high));
  EXPECT_EQ(percentile_bounds(histogram, percentile_ranks(3, 0.95), 3.0).low, 2.0)
      << "P(at most one of three below P95) = 0.7 %";
}

TEST(PercentileBounds, ValuesThatTheHistogramDoesNotTellApart) {  // below 1/128 of the largest, and below the floor
  LogHistogram wide, tiny;
  std::vector<float> values(100, 0.1F);
  values.back() = 1000.0F;
  wide.add(values);
  const Interval bounds = percentile_bounds(wide, percentile_ranks(100, 0.5), 1000.0);
  EXPECT_EQ(bounds.low, 0.0);
  EXPECT_GE(bounds.high, 0.1);
  tiny.add(std::vector<float>(10, 0.0F));
  EXPECT_EQ(percentile_bounds(tiny, percentile_ranks(10, 0.5), 0.0).low, 0.0);
  EXPECT_EQ(percentile_bounds(tiny, percentile_ranks(10, 0.5), 0.0).high, 0.0) << "the maximum";
}

}  // namespace
}  // namespace talus
