// Parts of a way within a distance of a line, against closed forms and against small steps along the way.
#include "products/touch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/scenes.hpp"

namespace talus {
namespace {

using Eigen::Vector2d;

TEST(Touch, StraightAcrossALine) {  // 20 m long, across in the middle: within 3 m from 7 to 13 m
  const auto touch = touch_of({{0, -10}, {0, 10}}, {-50, 0}, {50, 0}, 3.0);
  ASSERT_TRUE(touch);
  EXPECT_NEAR(touch->first, 0.35, 1e-12);
  EXPECT_NEAR(touch->last, 0.65, 1e-12);
}

TEST(Touch, ObliqueAcrossALine) {  // at 45 degrees the part is sqrt(2) times as long
  const auto touch = touch_of({{-10, -10}, {10, 10}}, {-50, 0}, {50, 0}, 3.0);
  ASSERT_TRUE(touch);
  EXPECT_NEAR(touch->first, 0.35, 1e-12);
  EXPECT_NEAR(touch->last, 0.65, 1e-12);
}

TEST(Touch, PastTheEndItIsRound) {  // 2 m past the end within 3 m: half a chord of sqrt(5)
  const auto touch = touch_of({{2, -10}, {2, 10}}, {-50, 0}, {0, 0}, 3.0);
  ASSERT_TRUE(touch);
  EXPECT_NEAR(touch->first, 0.5 - std::sqrt(5.0) / 20.0, 1e-12);
  EXPECT_NEAR(touch->last, 0.5 + std::sqrt(5.0) / 20.0, 1e-12);
  EXPECT_FALSE(touch_of({{3.1, -10}, {3.1, 10}}, {-50, 0}, {0, 0}, 3.0));
}

TEST(Touch, ABlockThatStandsStill) {
  EXPECT_TRUE(touch_of({{1, 2}, {1, 2}}, {-5, 0}, {5, 0}, 2.5));
  EXPECT_FALSE(touch_of({{1, 3}, {1, 3}}, {-5, 0}, {5, 0}, 2.5));
}

TEST(Touch, AgreesWithSmallSteps) {
  test::Numbers numbers(3);
  const auto point = [&] { return Vector2d(numbers.uniform(0.0, 10.0), numbers.uniform(0.0, 10.0)); };
  for (int i = 0; i < 300; ++i) {
    const Way way{point(), point()};
    const Vector2d a = point(), b = point();
    const double distance = numbers.uniform(0.1, 2.0);
    double first = 2.0, last = -1.0;
    constexpr int kSteps = 20'000;
    for (int k = 0; k <= kSteps; ++k) {
      const double share = static_cast<double>(k) / kSteps;
      const Vector2d p = way.from + share * (way.to - way.from);
      const double at = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      if ((p - a - at * (b - a)).norm() > distance) continue;
      first = std::min(first, share);
      last = std::max(last, share);
    }
    const auto touch = touch_of(way, a, b, distance);
    if (!touch) {
      EXPECT_EQ(last, -1.0) << i;
    } else if (last < 0.0) {
      EXPECT_LT(touch->last - touch->first, 1.0 / kSteps) << i;
    } else {
      EXPECT_NEAR(touch->first, first, 1.0 / kSteps) << i;
      EXPECT_NEAR(touch->last, last, 1.0 / kSteps) << i;
    }
  }
}

}  // namespace
}  // namespace talus
