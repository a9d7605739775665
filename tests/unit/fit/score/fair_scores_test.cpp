#include "talus/fit/score/fair_scores.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace talus::test {
namespace {

/// The Brier score is the CRPS of ones and zeros.
TEST(FairBrierScore, IsTheFairCrpsOfOnesAndZeros) {
  for (const int n : {2, 5, 24})
    for (int hits = 0; hits <= n; ++hits)
      for (const bool happened : {false, true}) {
        std::vector<double> trials(static_cast<std::size_t>(n), 0.0);
        std::fill_n(trials.begin(), hits, 1.0);
        EXPECT_NEAR(fair_brier_score(hits, n, happened), fair_crps(trials, happened ? 1.0 : 0.0), 1e-14) << n << hits;
      }
}

/// On average over the trials it is (p - 1)^2 for any number of them: summed exactly over the binomial distribution.
TEST(FairBrierScore, DoesNotDependOnTheNumberOfTrialsOnAverage) {
  constexpr double kP = 0.3;
  for (const int n : {2, 3, 24}) {
    double mean = 0.0;
    for (int hits = 0; hits <= n; ++hits) {
      const double ways = std::exp(std::lgamma(n + 1.0) - std::lgamma(hits + 1.0) - std::lgamma(n - hits + 1.0));
      mean += ways * std::pow(kP, hits) * std::pow(1.0 - kP, n - hits) * fair_brier_score(hits, n, true);
    }
    EXPECT_NEAR(mean, 0.49, 1e-12) << n;
  }
}

/// Two values a and b, cut off at t to a' and b': (|a' - y'| + |b' - y'| - |a' - b'|) / 2.
TEST(FairTailCrps, OfTwoValues) {
  const auto score = [](double y) {
    std::vector<double> x{30.0, 10.0};
    return fair_tail_crps(x, y, 20.0);
  };
  EXPECT_NEAR(score(40.0), (20.0 + 10.0 - 10.0) / 2.0, 1e-12);
  EXPECT_NEAR(score(25.0), (5.0 + 5.0 - 10.0) / 2.0, 1e-12);
  EXPECT_NEAR(score(0.0), (0.0 + 10.0 - 10.0) / 2.0, 1e-12);
  EXPECT_EQ(score(0.0), score(19.0)) << "below the threshold all values are alike";
}

/// Of a uniform forecast on (0, 1): the integral from t to 1 of (F(z) - 1{y <= z})^2, which is known.
TEST(FairTailCrps, OfAUniformForecast) {
  constexpr double kThreshold = 0.4;
  constexpr int kValues = 100'001;
  for (const double y : {0.1, 0.7}) {
    std::vector<double> x(kValues);
    for (int i = 0; i < kValues; ++i) x[static_cast<std::size_t>(i)] = (i + 0.5) / kValues;
    const double above = std::max(y, kThreshold);  // z^2 from the threshold to y, (1 - z)^2 from there to 1
    const double expected = (std::pow(above, 3) - std::pow(kThreshold, 3)) / 3.0 + std::pow(1.0 - above, 3) / 3.0;
    EXPECT_NEAR(fair_tail_crps(x, y, kThreshold), expected, 5e-6) << y;  // fair: less 1 / n of the mean distance
  }
}

}  // namespace
}  // namespace talus::test
