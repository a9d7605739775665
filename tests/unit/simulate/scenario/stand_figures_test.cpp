#include "talus/simulate/scenario/stand_figures.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(Spread, LargeNumbersAreWhole) {
  Spread spread;
  for (const double value : {2500.0, 4500.0, 4580.0}) spread.add(value);
  EXPECT_EQ(spread.text(), "2500 to 4580 (mean 3860)");
  Spread one;
  one.add(0.045);
  EXPECT_EQ(one.text(), "0.045");
}

}  // namespace
}  // namespace talus
