#include "talus/fit/score/holm.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace talus::test {
namespace {

TEST(Holm, IsTheTextbooks) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> p = holm(std::vector<double>{0.01, 0.04, none, 0.03, 0.005});
  EXPECT_DOUBLE_EQ(p[0], 0.03);  // 3 x 0.01
  EXPECT_DOUBLE_EQ(p[1], 0.06);  // 1 x 0.04, but no less than the one before
  EXPECT_TRUE(std::isnan(p[2]));
  EXPECT_DOUBLE_EQ(p[3], 0.06);  // 2 x 0.03
  EXPECT_DOUBLE_EQ(p[4], 0.02);  // 4 x 0.005
}

}  // namespace
}  // namespace talus::test
