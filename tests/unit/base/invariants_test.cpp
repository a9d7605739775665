#include <gtest/gtest.h>

#include "talus/base/sample.hpp"
#include "talus/physics/impact.hpp"
#include "talus/products/interval.hpp"

// A broken invariant ends the program, in builds that check invariants: Debug, or -DTALUS_CHECKED=ON.

namespace talus {
namespace {

class InvariantsDeathTest : public testing::Test {
 protected:
  void SetUp() override {
#ifndef TALUS_CHECKED
    GTEST_SKIP() << "this build does not check invariants";
#endif
  }
};

TEST_F(InvariantsDeathTest, MomentumGrowsAtNoImpact) {
  const Vec3 up(0.0, 0.0, 1.0), falling(1.0, 0.0, -5.0), still = Vec3::Zero();
  EXPECT_DEATH(rebound(falling, still, up, {1.5, 1.0}, 0.5, 0.6), "momentum is lost");
  EXPECT_DEATH(rebound(falling, still, 2.0 * up, {0.5, 0.5}, 0.5, 0.6), "unit vector");
}

TEST_F(InvariantsDeathTest, HitsAreNoMoreThanTrials) {
  EXPECT_DEATH(probability_bounds(3, 2, 0.95), "no more hits than trials");
}

TEST_F(InvariantsDeathTest, ASampleIsNotEmpty) {
  EXPECT_DEATH(quantile({}, 0.5), "a quantile is of a sample");
}

}  // namespace
}  // namespace talus
