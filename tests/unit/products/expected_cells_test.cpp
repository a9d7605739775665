#include "talus/products/expected_cells.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace talus {
namespace {

/// Cells whose rates are gamma distributed (shape k, mean `mean` a sample): how many have each number of passages is
/// negative binomial.
std::array<std::uint64_t, 5> cells_of(double all, double k, double mean) {
  const double q = mean / (mean + k);
  std::array<double, 5> share{};
  double rest = 1.0;
  for (int n = 0; n < 4; ++n) {
    share[n] =
        std::exp(std::lgamma(k + n) - std::lgamma(k) - std::lgamma(n + 1.0)) * std::pow(q, n) * std::pow(1 - q, k);
    rest -= share[n];
  }
  share[4] = rest;
  std::array<std::uint64_t, 5> cells{};
  for (std::size_t n = 1; n < 5; ++n) cells[n] = static_cast<std::uint64_t>(std::llround(all * share[n]));
  return cells;  // cells that no trajectory reached are not counted
}

TEST(ExpectedCells, OfGammaRatesAreThoseOfTheNegativeBinomial) {
  constexpr double kAll = 1e8;
  for (const double k : {0.3, 1.0, 2.5})
    for (const double mean : {0.3, 1.0, 3.0})
      for (const double times : {2.0, 10.0, 100.0}) {
        const double expected = kAll * (1.0 - std::pow(1.0 + times * mean / k, -k));
        EXPECT_NEAR(expected_cells(cells_of(kAll, k, mean), times, kAll) / expected, 1.0, 1e-4)
            << k << ' ' << mean << ' ' << times;
      }
}

TEST(ExpectedCells, NeverFewerThanSeenNorMoreThanThereAre) {
  const std::array<std::uint64_t, 5> seen{0, 900, 300, 100, 50}, none{0, 0, 0, 0, 70}, once{0, 500, 0, 0, 0};
  EXPECT_EQ(expected_cells(seen, 1.0, 1e6), 1350.0);  // as many trajectories again: none
  EXPECT_EQ(expected_cells(seen, 1e9, 1400.0), 1400.0);
  EXPECT_EQ(expected_cells(none, 10.0, 1e6), 70.0);    // all are seen often
  EXPECT_EQ(expected_cells(once, 10.0, 1e6), 5000.0);  // none is seen twice
}

}  // namespace
}  // namespace talus
