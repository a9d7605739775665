#include "fit/score/robust_density.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/campaigns.hpp"
#include "talus/fit/score/score.hpp"

namespace talus::test {
namespace {

const std::vector<double> kBroad{-1.0, 1.0};  // mean 0, standard deviation 1
/// Student's t of three degrees of freedom at 0 is 2 / (pi sqrt 3) = 0.3675526, at 3 it is that over 16.
constexpr double kT0 = 0.3675525969478613, kT3 = kT0 / 16.0;

/// All simulated values are alike: the kernel is the normal of a hundredth of the unit.
TEST(LogDensity, OfOneValueByHand) {
  const std::vector<double> alike(20, 0.0);
  const double peak = 1.0 / (0.01 * std::sqrt(2.0 * kPi));
  EXPECT_NEAR(log_density(alike, kBroad, 0.0, 1.0), std::log(0.95 * peak + 0.05 * kT0), 1e-12);
  EXPECT_NEAR(log_density(alike, kBroad, 3.0, 1.0), std::log(0.05 * kT3), 1e-12);
}

/// No value is worse than ln 20 below what it would be under the broad density, however far.
TEST(LogDensity, AnOutlierCostsABoundedAmount) {
  std::vector<double> simulated;
  for (int i = 0; i < 50; ++i) simulated.push_back(0.1 * i);
  for (const double y : {100.0, 1e3, 1e9}) {
    const double broad = std::log(2.0 / (kPi * std::sqrt(3.0) * std::pow(1.0 + y * y / 3.0, 2)));
    EXPECT_NEAR(log_density(simulated, kBroad, y, 1.0), broad - std::log(20.0), 1e-9) << y;
  }
}

/// The unit of the values does not matter, and the density of a large normal sample is the normal one: -ln sqrt(2 pi)
/// at its mean, less the width of the kernels.
TEST(LogDensity, OfANormalSample) {
  Numbers numbers(3);
  std::vector<double> x(20000), metres, broad;
  for (double& v : x) v = numbers.normal();
  const double h = 1.06 * std::pow(20000.0, -0.2);
  const double expected = 0.95 / std::sqrt(2.0 * kPi * (1.0 + h * h)) + 0.05 * kT0;
  EXPECT_NEAR(std::exp(log_density(x, kBroad, 0.0, 1.0)), expected, 0.01);
  for (const double v : x) metres.push_back(7.0 * v);
  for (const double v : kBroad) broad.push_back(7.0 * v);
  EXPECT_NEAR(log_density(metres, broad, 3.5, 7.0), log_density(x, kBroad, 0.5, 1.0), 1e-10);
}

/// In plan: at the mean of a large standard normal sample 1 / (2 pi), less the width of the kernels.
TEST(LogDensity, OfANormalSampleInPlan) {
  Numbers numbers(4);
  std::vector<Eigen::Vector2d> places(5000);
  for (Eigen::Vector2d& p : places) p = {numbers.normal(), numbers.normal()};
  const double wider = 1.0 + std::pow(5000.0, -1.0 / 3.0) + 1e-4;
  const double expected = 0.95 / (2.0 * kPi * wider) + 0.05 / (2.0 * kPi);
  EXPECT_NEAR(std::exp(log_density(places, places, Eigen::Vector2d(0.0, 0.0), 1.0)), expected, 0.01);
}

TEST(LogProbability, ByHand) {
  EXPECT_NEAR(log_probability(3.0, 9.0, 0.5, true), std::log(0.95 * 0.35 + 0.025), 1e-12);
  EXPECT_NEAR(log_probability(3.0, 9.0, 0.5, false), std::log(0.95 * 0.65 + 0.025), 1e-12);
  EXPECT_NEAR(log_probability(0.0, 1e9, 0.2, true), std::log(0.01), 1e-6);
}

/// The model that made the data has a better log score than one of another ground, and both are compared on the rows
/// of the error.
TEST(LogScore, IsBestForTheModelThatMadeTheData) {
  Campaign c = campaign_on_slope(60);
  const Model truth = model_of_slope();
  measure(c, truth, 5);
  Model other = truth;
  other.grounds[0].theta_scale *= 2.0;
  const std::vector<bool> rows = fitting_rows(c);
  const ScoreOptions log{ScoreRule::LogDensity, kFewestSimulated, {}};
  const auto runs = observe(c, truth, {200, 1, 0, 1, {}, {}}), others = observe(c, other, {200, 1, 0, 1, {}, {}});
  const Score right = score(c, runs, rows, log), wrong = score(c, others, rows, log);
  EXPECT_LT(right.total, wrong.total);
  const Score fair = score(c, runs, rows);
  ASSERT_EQ(right.rows.size(), fair.rows.size());
  for (std::size_t r = 0; r < fair.rows.size(); ++r) EXPECT_EQ(right.rows[r].block, fair.rows[r].block);
}

}  // namespace
}  // namespace talus::test
