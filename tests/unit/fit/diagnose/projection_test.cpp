#include "talus/fit/diagnose/projection.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "support/scenes.hpp"

namespace talus::test {
namespace {

/// Share of data sets without an effect whose statistic is above a value, by simulation: two estimates of this
/// correlation and variance 1, neither below zero.
double simulated_tail(double correlation, double value, int sets) {
  Numbers numbers(17);
  const Eigen::Matrix2d covariance{{1.0, correlation}, {correlation, 1.0}}, information = covariance.inverse();
  int above = 0;
  for (int set = 0; set < sets; ++set) {
    const double a = numbers.normal(), b = numbers.normal();
    const Eigen::Vector2d estimate(a, correlation * a + std::sqrt(1.0 - correlation * correlation) * b);
    const Eigen::Vector2d score = information * estimate;
    double statistic = 0.0;
    if (estimate.minCoeff() > 0.0)
      statistic = score.dot(estimate);
    else
      for (int i = 0; i < 2; ++i)
        statistic = std::max(statistic, std::pow(std::max(0.0, score[i]), 2) / information(i, i));
    above += statistic > value;
  }
  return static_cast<double>(above) / sets;
}

TEST(ChiBar, OfTwoCorrelatedEstimatesIsWhatSimulationGives) {
  constexpr int kSets = 200'000;
  for (const double correlation : {-0.9, -0.5, 0.0, 0.6, 0.9})
    for (const double value : {0.5, 3.0, 5.0}) {
      const double p = chi_bar_tail(value, 2, 2, correlation);
      EXPECT_NEAR(simulated_tail(correlation, value, kSets), p, 5.0 * std::sqrt(p * (1.0 - p) / kSets))
          << correlation << ' ' << value;
    }
  // The weights of uncorrelated estimates would be off by far more.
  EXPECT_GT(chi_bar_tail(3.0, 2, 2, 0.9) / chi_bar_tail(3.0, 2, 2, 0.0), 1.25);
  EXPECT_LT(chi_bar_tail(3.0, 2, 2, -0.9) / chi_bar_tail(3.0, 2, 2, 0.0), 0.75);
}

TEST(ChiBar, AtItsLimits) {
  const double one = std::erfc(std::sqrt(1.5)), two = std::exp(-1.5);  // chi squared above 3
  EXPECT_NEAR(chi_bar_tail(3.0, 2, 0, 0.0), two, 1e-12);
  EXPECT_NEAR(chi_bar_tail(3.0, 1, 1, 0.0), 0.5 * one, 1e-12);
  EXPECT_NEAR(chi_bar_tail(3.0, 2, 1, 0.7), 0.5 * one + 0.5 * two, 1e-12) << "the free one takes its part with it";
  EXPECT_NEAR(chi_bar_tail(3.0, 2, 2, -1.0), 0.5 * one, 1e-12) << "never both inside";
  EXPECT_NEAR(chi_bar_tail(3.0, 2, 2, 1.0), 0.5 * one + 0.5 * two, 1e-12);
  EXPECT_EQ(chi_bar_tail(0.0, 2, 2, 0.3), 1.0);
}

/// Two estimates with the information of a covariance of scores of 0.6 between them: the estimates have -0.6.
TEST(ChiBar, TheProjectionUsesTheCorrelationOfTheEstimates) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  covariance(1, 2) = covariance(2, 1) = 0.6;
  TestedPlace place{{0}, Eigen::MatrixXd::Identity(3, 3).rightCols(2), {true, true}};
  const Projection projection(place, covariance, 1, Eigen::VectorXd::Ones(1), 1.0);
  const Verdict v = projection.verdict(Eigen::Vector3d(0.0, 2.0, 2.0));
  EXPECT_NEAR(v.p_value, chi_bar_tail(v.statistic, 2, 2, -0.6), 1e-6);
}

/// One parameter of the ground and one of an effect, whose scores have variances 4 and 9 and a covariance of 3: the
/// ground, free to move within its prior, takes 3^2 / (4 + 0.5) of the effect's information.
TEST(StandardErrors, LoseWhatTheGroundImitates) {
  const Eigen::Matrix2d covariance{{4.0, 3.0}, {3.0, 9.0}};
  const TestedPlace place{{0}, Eigen::Vector2d(0.0, 1.0), {true}};
  const Projection held(place, covariance, 1, Eigen::VectorXd::Ones(1), 1e12);
  EXPECT_NEAR(held.standard_errors()[0], 1.0 / 3.0, 1e-6);
  const Projection free(place, covariance, 1, Eigen::VectorXd::Ones(1), 1e-12);
  EXPECT_NEAR(free.standard_errors()[0], 1.0 / std::sqrt(9.0 - 9.0 / 4.0), 1e-6);
}

/// A ground 3 standard deviations outside its prior, in a linear model: information 4 of the ground, 9 of the effect, 3
/// between them, no effect. The penalised fit ends 3 / (4 + 1) = 0.6 short of the ground. What is left of it must not
/// pass for the effect: a further step of the ground, with a prior centred at the fit, takes four fifths of it away.
/// (With the gradient of the prior in the score the ground would not move, and all of it would pass for the effect.)
TEST(Prior, ThatHoldsTheGroundBackIsHardlyTakenForAnEffect) {
  const Eigen::Matrix2d covariance{{4.0, 3.0}, {3.0, 9.0}};
  const Projection projection({{0}, Eigen::Vector2d(0.0, 1.0), {false}}, covariance, 1, Eigen::VectorXd::Ones(1), 1.0);
  const double short_by = 0.6, held = 3.0 * short_by, moved = held / 5.0;
  const Eigen::Vector2d scores = short_by * Eigen::Vector2d(4.0, 3.0);
  const double information = 9.0 - 2.0 * 9.0 / 5.0 + 4.0 * 9.0 / 25.0;
  EXPECT_NEAR(projection.verdict(scores).estimate[0], moved / information, 1e-6);
}

/// Two independent estimates of which only the second may be negative: the bounded optimum by hand.
TEST(Projection, TheEstimateStaysWithinItsBounds) {
  TestedPlace place{{0}, Eigen::MatrixXd::Identity(3, 3).rightCols(2), {true, false}};
  const Projection projection(place, Eigen::MatrixXd::Identity(3, 3), 1, Eigen::VectorXd::Ones(1), 1.0);
  const Verdict v = projection.verdict(Eigen::Vector3d(0.0, -2.0, -2.0));
  EXPECT_EQ(v.estimate[0], 0.0);
  EXPECT_NEAR(v.estimate[1], -2.0, 1e-6);
  EXPECT_NEAR(v.statistic, 4.0, 1e-6);  // 2^2
  // Half chi squared of one freedom, half of two: 0.5 erfc(sqrt(4/2)) + 0.5 exp(-4/2).
  EXPECT_NEAR(v.p_value, 0.5 * std::erfc(std::sqrt(2.0)) + 0.5 * std::exp(-2.0), 1e-7);
}

TEST(Projection, EverySetOfFewDaysAndRunsOfMany) {
  const auto places = [](std::size_t days) {
    std::vector<Candidate> list(days);
    for (Candidate& c : list) c = {"wet-ground", "", {{}}, 1, {}};
    return places_of(list, 0, static_cast<Eigen::Index>(days), {}).size();
  };
  EXPECT_EQ(places(3), 6U);   // 2^3 - 2
  EXPECT_EQ(places(6), 62U);  // 2^6 - 2
  EXPECT_EQ(places(8), 35U);  // runs of 1 to 7 of 8 days: 8 + 7 + ... + 2
}

}  // namespace
}  // namespace talus::test
