#include "talus/products/passage_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/scenes.hpp"

namespace talus {
namespace {

/// Garwood's 95 % bounds of a Poisson count (1936, Biometrika 28, 437-442).
TEST(TableInterval, OfEqualCountsIsGarwoods) {
  const struct {
    double count, low, high;
  } published[] = {
      {0, 0.0, 3.6889}, {1, 0.0253, 5.5716}, {2, 0.2422, 7.2247}, {10, 4.7954, 18.3904}, {50, 37.1110, 65.9188}};
  for (const auto& row : published) {
    const Bounded bounds = table_interval(row.count * 0.5, row.count * 0.25, 0.5);
    EXPECT_NEAR(bounds.low, 0.5 * row.low, 2e-4 * row.low + 5e-5) << row.count;
    EXPECT_NEAR(bounds.high, 0.5 * row.high, 2e-4 * row.high) << row.count;
  }
}

TEST(TableInterval, AgreesWithTheQuantilesOfTheLibrary) {
  for (double count = 1.0; count < 1e8; count *= 1.37) {
    const Bounded table = table_interval(count, count, 1.0), exact = gamma_interval(count, count, 1.0);
    EXPECT_NEAR(table.high, exact.high, 1e-4 * exact.high) << count;
    EXPECT_NEAR(table.low, exact.low, 1e-4 * exact.low) << count;
  }
}

TEST(MeanLength, BlocksThatAllPassAlikeAreSure) {  // 1000 blocks with 3 m each: no spread, only what one more may do
  const Bounded length = mean_length(3000.0, 9000.0, 3.0, 1000.0);
  EXPECT_EQ(length.value, 3.0);
  EXPECT_GT(length.low, 2.98);
  EXPECT_LT(length.high, 3.02);
}

/// One passage is one count: the lower bound of Garwood is -ln(0.975), although length and square are rounded each by
/// itself, as the tallies do.
TEST(MeanLength, OnePassageHasTheBoundOfOneCount) {
  const auto rounded = [](double value) { return std::round(value * 0x1p20) * 0x1p-20; };
  for (const double length : {0.1, 0.7, 3.3269, 4.0072}) {
    const Bounded bounds = mean_length(rounded(length), rounded(length * length), std::hypot(5.0, 5.0), 1000.0);
    EXPECT_NEAR(bounds.low / bounds.value, -std::log(0.975), 1e-4) << length;
  }
}

/// How many per cent of the intervals miss the true mean, of blocks that each pass with a probability and then leave a
/// random length in the cell.
double missed(double released, double probability, double mean, const std::function<double(test::Numbers&)>& draw) {
  constexpr int kTimes = 2000;  // standard error of 5 %: 0.5 %
  test::Numbers numbers(7);
  int out = 0;
  for (int time = 0; time < kTimes; ++time) {
    double length = 0.0, squares = 0.0;
    for (int block = 0; block < released; ++block) {
      if (numbers.uniform(0.0, 1.0) >= probability) continue;
      const double of_block = draw(numbers);
      length += of_block;
      squares += of_block * of_block;
    }
    const Bounded bounds = mean_length(length, squares, std::hypot(5.0, 5.0), released);
    out += probability * mean < bounds.low || probability * mean > bounds.high ? 1 : 0;
  }
  return 100.0 * out / kTimes;
}

/// Rare to sure, and any lengths up to the diagonal: the narrower of two intervals still covers 95 %. It catches
/// margins from the variance alone, which miss 60 % of rare passages.
TEST(MeanLength, CoversNinetyFivePerCent) {
  const auto equal = [](test::Numbers&) { return 5.0; };
  const auto even = [](test::Numbers& numbers) { return numbers.uniform(0.0, 7.0); };
  const auto grazing = [](test::Numbers& numbers) { return 0.1 - 0.5 * std::log(1.0 - numbers.uniform(0.0, 0.999)); };
  const double of_grazing = 0.1 + 0.5 * (1.0 - 0.001 * (1.0 - std::log(0.001))) / 0.999;
  for (const double probability : {0.0005, 0.002, 0.01, 0.05, 0.3, 0.7, 0.97}) {
    EXPECT_LE(missed(1000.0, probability, 5.0, equal), 7.5) << probability;
    EXPECT_LE(missed(1000.0, probability, 3.5, even), 7.5) << probability;
    EXPECT_LE(missed(300.0, probability, of_grazing, grazing), 7.5) << probability;
  }
}

/// Lengths of 15 m in the mean, exponential, in a cell of 7 m: 50 passages and more are covered.
TEST(MeanLength, CoversBlocksThatWander) {
  const auto wandering = [](test::Numbers& numbers) { return -15.0 * std::log(1.0 - numbers.uniform(0.0, 1.0)); };
  for (const double probability : {0.05, 0.3, 0.97}) EXPECT_LE(missed(1000.0, probability, 15.0, wandering), 7.5);
}

}  // namespace
}  // namespace talus
