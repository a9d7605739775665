#include "talus/products/screen_summary.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

Crossing crossing(std::uint32_t block, double speed) {
  Crossing c{0, block, 1, 0, 0, 0, speed, 2.0, 1.0, 1000.0, 1.0, 30.0, 0.0};
  c.dip = radians(30.0);
  c.incidence = radians(45.0);
  return c;
}

/// Speeds 1 to 101 of 100 blocks, the last of which crosses twice.
TEST(ScreenSummary, ByHand) {
  ScreenSummary summary(2);
  std::vector<Crossing> crossings;
  for (std::uint32_t i = 1; i <= 101; ++i) crossings.push_back(crossing(std::min(i, 100U), i));
  summary.add(std::span(crossings).first(40));
  summary.add(std::span(crossings).subspan(40));
  const auto row = [&](std::size_t quantity) { return summary.row(1, quantity); };
  EXPECT_EQ(row(0).crossings, 101U);
  EXPECT_EQ(row(0).blocks, 100U);
  EXPECT_EQ(row(0).mean, 51.0);
  EXPECT_EQ(row(0).p50, 51.0);
  EXPECT_NEAR(row(0).p95, 96.0, 1e-9);
  EXPECT_NEAR(row(0).p99, 100.0, 1e-9);
  EXPECT_EQ(row(0).maximum, 101.0);
  EXPECT_NEAR(row(1).maximum, 0.5 * 101.0 * 101.0, 0.01);                 // kJ, of 1000 kg
  EXPECT_NEAR(row(2).maximum - row(1).maximum, 0.5 * 0.4 * 0.25, 0.001);  // rotation: 2/5 m R^2 = 100 kg m2, 1 rad/s
  EXPECT_NEAR(row(5).mean, 30.0, 1e-5);
  EXPECT_NEAR(row(6).mean, 45.0, 1e-5);
  EXPECT_EQ(row(7).mean, 30.0);
  EXPECT_EQ(summary.row(0, 0).crossings, 0U);
  EXPECT_TRUE(std::isnan(summary.row(0, 0).mean));
}

}  // namespace
}  // namespace talus
