#include "talus/products/held_at_release.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

StopRow stop_at(double x, double y, End end) {
  StopRow row{};
  row.end = end;
  row.diameter = 0.5F;
  row.x_release = 100.0F, row.y_release = 50.0F;
  row.x = 100.0 + x, row.y = 50.0 + y;
  return row;
}

TEST(HeldAtRelease, WithinTwoDiametersInPlanAndAtRest) {
  EXPECT_TRUE(held_at_release(stop_at(0.0, 0.0, End::Stopped)));
  EXPECT_TRUE(held_at_release(stop_at(0.6, 0.8, End::Trapped)));  // 1 m
  EXPECT_FALSE(held_at_release(stop_at(0.6, 0.81, End::Stopped)));
  EXPECT_FALSE(held_at_release(stop_at(-2.0, 0.0, End::Stopped)));
  for (const End end : {End::Left, End::Caught, End::Limit}) EXPECT_FALSE(held_at_release(stop_at(0.0, 0.0, end)));
}

}  // namespace
}  // namespace talus
