#include "talus/products/passage_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace talus
