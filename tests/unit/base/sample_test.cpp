#include "talus/base/sample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace talus {
namespace {

TEST(Sample, MedianAndMiddleOfWholeNumbersInAnyOrder) {
  std::vector<double> numbers(1001);
  std::iota(numbers.rbegin(), numbers.rend(), 0.0);
  EXPECT_EQ(median_of(numbers), 500.0);
  EXPECT_EQ(median_of({4.0, 1.0, 2.0, 3.0}), 2.5);
  const Interval middle = middle_of(numbers);
  EXPECT_NEAR(middle.low, 25.0, 1e-9);
  EXPECT_NEAR(middle.high, 975.0, 1e-9);
}

TEST(Sample, NothingIsKnownOfAnEmptyOne) {
  EXPECT_TRUE(std::isnan(median_of({})));
  EXPECT_TRUE(std::isnan(middle_of({}).low) && std::isnan(middle_of({}).high));
}

}  // namespace
}  // namespace talus
