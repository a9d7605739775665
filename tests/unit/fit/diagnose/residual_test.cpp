#include "talus/fit/diagnose/residual.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {
namespace {

constexpr int kTrials = 19;           // a value above all of them has the rank 19.5 / 20
constexpr double kZAbove = 1.959964;  // Phi^-1(0.975)

/// One block, released in the origin.
Campaign one_block() {
  Campaign c;
  c.blocks.resize(1);
  return c;
}

/// Component of the residual of the only block that belongs to an observable: its place, or its spread.
double component(const ResidualSpace& space, const std::string& name, bool spread) {
  const auto& all = space.observables();
  const auto at = std::ranges::find(all, name, &Observable::name) - all.begin();
  return space.of_measured(0)[at + (spread ? std::ssize(all) : 0)];
}

/// The trials stop 100 m away, the measured block 20 m to one side of their middle, in every direction.
TEST(Residual, OfABlockLeftOfTheMeanStopIsPositive) {
  BlockRuns runs;
  runs.trials = kTrials;
  for (const double towards : {0.0, 0.5, 2.0, 4.0}) {
    const Eigen::Vector2d forward(std::cos(towards), std::sin(towards));
    const double quarter = towards + 0.5 * std::numbers::pi;  // angles grow to the left
    const Eigen::Vector2d left(std::cos(quarter), std::sin(quarter));
    runs.x.clear(), runs.y.clear();
    for (int t = 0; t < kTrials; ++t) {
      const Eigen::Vector2d stop = 100.0 * forward + (t - 9.0) * left;
      runs.x.push_back(stop.x()), runs.y.push_back(stop.y());
    }
    for (const double side : {1.0, -1.0}) {
      Campaign c = one_block();
      c.blocks[0].stop = 100.0 * forward + side * 20.0 * left;
      EXPECT_NEAR(component(ResidualSpace(c, {runs}, {}), "lateral", false), side * kZAbove, 1e-6) << towards;
    }
  }
}

/// Two samples. The simulated speeds are 1 to 19 m/s at both; only at the farther
/// one the measured speed is not in their middle. Spread, (z^2 - 1) / sqrt(2): -0.7071 in the middle, 2.0092 above all.
TEST(Residual, OfASampleBelongsToItsHalfOfThePath) {
  Campaign c = one_block();
  c.blocks[0].samples = {{.x = 10.0, .distance = 10.0, .speed = 10.0}, {.x = 50.0, .distance = 50.0, .speed = 25.0}};
  BlockRuns runs;
  runs.trials = kTrials;
  runs.x.assign(kTrials, kNotGiven);
  runs.y = runs.x;
  runs.samples.resize(2);
  for (BlockRuns::AtSample& sample : runs.samples) {
    for (int t = 1; t <= kTrials; ++t) sample.speed.push_back(t);
    sample.spin.assign(kTrials, kNotGiven);
  }
  const ResidualSpace space(c, {runs}, {});
  EXPECT_NEAR(component(space, "sample speed early", false), 0.0, 1e-12);
  EXPECT_NEAR(component(space, "sample speed early", true), -0.707107, 1e-6);
  EXPECT_NEAR(component(space, "sample speed late", false), kZAbove, 1e-6);
  EXPECT_NEAR(component(space, "sample speed late", true), 2.009215, 1e-6);
}

}  // namespace
}  // namespace talus
