#include "talus/products/energy_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "talus/base/bounds.hpp"

namespace talus {
namespace {

constexpr double kDegrees = 180.0 / kPi;

TEST(EnergyLine, ByHand) {
  const Vec3 top(100.0, 200.0, 50.0);
  EXPECT_NEAR(energy_line_angle(top, {130.0, 240.0, 0.0}) * kDegrees, 45.0, 1e-12) << "50 m down on 50 m in plan";
  EXPECT_NEAR(energy_line_angle(top, {100.0, 300.0, 50.0 - 100.0 * std::tan(kPi / 6.0)}) * kDegrees, 30.0, 1e-12);
  EXPECT_NEAR(energy_line_angle(top, {100.0, 200.0, 49.0}) * kDegrees, 90.0, 1e-12) << "straight down";
  EXPECT_EQ(energy_line_angle(top, {150.0, 200.0, 50.0}), 0.0);
  EXPECT_LT(energy_line_angle(top, {150.0, 200.0, 51.0}), 0.0);
  EXPECT_TRUE(std::isnan(energy_line_angle(top, top)));
}

TEST(EnergyLine, OfAStop) {
  Release release;
  release.motion.position = {10.0, 20.0, 70.0};
  Path path;
  path.end = End::Stopped;
  path.vertices.resize(2);
  path.vertices[1].motion.position = {50.0, 50.0, 40.0};  // 50 m in plan, 30 m down
  EXPECT_NEAR(stop_row(release, path).energy_line * kDegrees, 30.963757, 1e-5);
}

TEST(EnergyLines, OfTheBlocksThatStopped) {
  std::vector<StopRow> rows(200);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].end = i % 2 == 0 ? End::Stopped : End::Trapped;
    rows[i].energy_line = static_cast<float>((30.0 + 0.1 * static_cast<double>((i * 37) % 200)) / kDegrees);
  }
  for (const End end : {End::Left, End::Caught, End::Limit}) {
    rows.push_back({});
    rows.back().end = end;
    rows.back().energy_line = 0.1F;
  }
  rows.push_back({});
  rows.back().energy_line = static_cast<float>(kNotGiven);  // it did not move
  EnergyLines lines;
  lines.add(rows);
  EXPECT_EQ(lines.count(), 200U);
  EXPECT_NEAR(lines.least(), 30.0, 1e-9);
  EXPECT_NEAR(lines.percentile(0.05), 30.9, 1e-9) << "the 10th of 200";
  EXPECT_NEAR(lines.percentile(0.5), 39.9, 1e-9);
  EXPECT_NEAR(lines.percentile(1.0), 49.9, 1e-9);
  EXPECT_EQ(lines.farther_than(), 0.0) << "all stopped at their release";
}

TEST(EnergyLines, OfThoseFarAwayIfTheyAreEnough) {
  StopRow near{}, far{};
  near.end = far.end = End::Stopped;
  near.x_release = far.x_release = 10.0F, near.y_release = far.y_release = 20.0F;
  near.x = 70.0, near.y = 100.0, near.energy_line = static_cast<float>(12.0 / kDegrees);  // 100 m away in plan
  far.x = 70.1, far.y = 100.0, far.energy_line = static_cast<float>(31.0 / kDegrees);
  EnergyLines lines;
  lines.add(std::vector(99, far));
  EXPECT_EQ(lines.farther_than(), 0.0) << "99 are too few";
  lines.add(std::vector(1, far));
  lines.add(std::vector(1900, near));
  EXPECT_EQ(lines.farther_than(), 100.0);
  EXPECT_EQ(lines.count(), 100U);
  EXPECT_NEAR(lines.least(), 31.0, 1e-9);
  lines.add(std::vector(1, near));
  EXPECT_EQ(lines.farther_than(), 0.0) << "less than one in twenty";
  EXPECT_EQ(lines.count(), 2001U);
  EXPECT_NEAR(lines.least(), 12.0, 1e-9);
}

}  // namespace
}  // namespace talus
