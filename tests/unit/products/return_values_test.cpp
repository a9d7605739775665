#include "talus/products/return_values.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

/// 1, 2, ... 100 m, in no order, each by a block of 0.001 per year of 100 000 such blocks.
std::vector<LineCrossing> hundred_heights() {
  std::vector<LineCrossing> crossings;
  for (std::size_t i = 0; i < 100; ++i)
    crossings.push_back({.height = static_cast<double>((37 * i) % 100 + 1), .weight = 0.001, .block = i, .piece = i});
  return crossings;
}

CrossingRate rate_of(const CrossingSums& line) {
  const WeightScale scale{0x1p-40, 0x1p-60, 100.0, std::llround(0.001 * 0x1p40), 100'000, true};
  return [=](const CrossingSums& counted) { return crossings_per_year(counted, line, scale); };
}

std::vector<Bounded> heights_once_in(const std::vector<double>& years, const std::vector<LineCrossing>& crossings) {
  return values_once_in(years, crossings, &LineCrossing::height, rate_of(sums_of(crossings)));
}

/// Once in 100 years are ten crossings: those of 91 m and more. Garwood's 95 % bounds of a Poisson count: 3 has an
/// upper one of 8.77, 4 of 10.24; 17 a lower one of 9.90, 18 of 10.67. So ten are reached by 4 and 18 crossings.
TEST(ValuesOnceIn, AreThoseOfSoManyCrossings) {
  const Bounded height = heights_once_in({100.0}, hundred_heights())[0];
  EXPECT_EQ(height.value, 91.0);
  EXPECT_EQ(height.high, 97.0);
  EXPECT_EQ(height.low, 83.0);
}

/// The upper bound of no crossing is 3.69, that of one 5.57 (Garwood): four in 1000 years are within the second, three
/// are within the first.
TEST(ValuesOnceIn, HaveNoUpperBoundWhereTheRunIsTooSmall) {
  const auto heights = heights_once_in({1000.0 / 4.0, 1000.0 / 3.0}, hundred_heights());
  EXPECT_EQ(heights[0].high, 100.0);
  EXPECT_EQ(heights[1].high, std::numeric_limits<double>::infinity());
}

TEST(ValuesOnceIn, AreZeroWhereCrossingsAreRarer) {
  const auto heights = heights_once_in({1000.0 / 100.0, 1000.0 / 101.0, 5.0}, hundred_heights());
  EXPECT_EQ(heights[0].value, 1.0);
  EXPECT_EQ(heights[1].value, 0.0);
  EXPECT_GT(heights[1].high, 0.0);
  EXPECT_EQ(heights[2].high, 0.0);
}

/// Ten blocks of ten pieces, the largest of 10, 20, ... 100 m: once in 250 years come the four largest blocks.
TEST(ValuesOnceIn, CountABlockOnceByItsLargestPiece) {
  std::vector<LineCrossing> pieces = hundred_heights();
  for (LineCrossing& piece : pieces) piece.block = static_cast<std::size_t>(piece.height - 1.0) / 10;
  const auto heights = heights_once_in({250.0, 1000.0 / 11.0}, pieces);
  EXPECT_EQ(heights[0].value, 70.0);
  EXPECT_EQ(heights[1].value, 0.0) << "ten blocks in a thousand years, not a hundred";
}

/// A lower bound that falls from 1.2 to 0.8 at the fourth crossing and comes back: the first that is enough counts.
TEST(ValuesOnceIn, OfALowerBoundThatFallsTheFirstCounts) {
  std::vector<LineCrossing> crossings;
  for (std::size_t i = 0; i < 5; ++i)
    crossings.push_back({.height = 5.0 - static_cast<double>(i), .weight = 1.0, .block = i, .piece = i});
  const auto rate = [](const CrossingSums& counted) {
    constexpr double kLow[] = {0.0, 0.3, 0.6, 1.2, 0.8, 1.5};
    return Bounded{counted.sum, kLow[static_cast<std::size_t>(counted.sum)], 2.0 * counted.sum};
  };
  EXPECT_EQ(values_once_in(std::vector{1.0}, crossings, &LineCrossing::height, rate)[0].low, 3.0);
}

}  // namespace
}  // namespace talus
