#include "talus/fit/calibrate.hpp"

#include <Eigen/Cholesky>

#include "support/campaigns.hpp"
#include "talus/base/error.hpp"
#include "talus/fit/quadratic.hpp"
#include "talus/fit/uncertainty.hpp"

namespace talus::test {
namespace {

std::vector<Parameter> two_parameters(const Campaign& c, const Model& start) {
  const std::vector<std::string> keys{"theta_scale", "En50"};
  return ground_parameters(c, start, keys, {true});
}

TEST(Parameters, ThereAndBack) {
  const Campaign c = campaign_on_slope(1);
  const Model start = model_of_slope();
  for (const Parameter& p : two_parameters(c, start)) {
    EXPECT_NEAR(p.value(0.0), p.get(start), 1e-12);
    EXPECT_NEAR(p.value(1.0), p.get(start) * std::exp(1.0), 1e-9);
    EXPECT_NEAR(p.z(p.value(-0.7)), -0.7, 1e-12);
    EXPECT_EQ(p.value(99.0), p.upper);
  }
  EXPECT_EQ(two_parameters(c, start)[1].key, "ground.zones.default.En50");
  EXPECT_THROW(ground_parameters(c, start, std::vector<std::string>{"E50"}, {true}), InputError);
  EXPECT_TRUE(ground_parameters(c, start, std::vector<std::string>{"phi"}, {false}).empty());
}

/// A quadratic is found exactly from places without noise.
TEST(QuadraticFit, ExactForAQuadratic) {
  Numbers numbers(2);
  const Eigen::Vector3d centre(1.0, -2.0, 0.5), g(0.3, -1.0, 2.0);
  Eigen::Matrix3d h;
  h << 4.0, 1.0, 0.0, 1.0, 3.0, -0.5, 0.0, -0.5, 2.0;
  Eigen::MatrixXd places(3, 40), values(40, 1);
  for (Eigen::Index i = 0; i < 40; ++i) {
    const Eigen::Vector3d u = numbers.vector(1.0);
    places.col(i) = centre + u;
    values(i, 0) = 5.0 + g.dot(u) + 0.5 * u.dot(h * u);
  }
  const QuadraticFit fit(places, Eigen::VectorXd::Ones(40), centre, {0.0, 0.0});
  const Eigen::VectorXd c = fit.coefficients(values);
  EXPECT_LT((fit.gradient(c) - g).norm(), 1e-6);
  EXPECT_LT((fit.curvature(c) - h).norm(), 1e-6);
  const Eigen::Vector3d wide = Eigen::Vector3d::Constant(10.0);
  EXPECT_LT((minimum_in_box(g, h, -wide, wide) + h.ldlt().solve(g)).norm(), 1e-4);
  const Eigen::Vector3d bound(10.0, 10.0, 0.1);  // the third coordinate wants to go below -0.1
  const Eigen::VectorXd at_bound = minimum_in_box(g, h, -bound, bound);
  EXPECT_EQ(at_bound[2], -0.1);
  EXPECT_NEAR((g + h * at_bound)[0], 0.0, 1e-4);
}

TEST(QuadraticFit, NegativeCurvatureIsNone) {
  Eigen::MatrixXd places(1, 5), values(5, 1);
  places << -2, -1, 0, 1, 2;
  for (Eigen::Index i = 0; i < 5; ++i) values(i, 0) = -places(0, i) * places(0, i);
  const QuadraticFit fit(places, Eigen::VectorXd::Ones(5), Eigen::VectorXd::Zero(1), {0.0, 0.0});
  EXPECT_EQ(fit.curvature(fit.coefficients(values))(0, 0), 0.0);
}

/// Data of a known model: the fit comes back to it from elsewhere, within what its interval says (from 24 such
/// campaigns the root mean square error of theta_scale is 1.2, that of En50 0.9 of the standard deviations that the
/// intervals stand for), and is the same for any number of threads.
TEST(Calibrate, ComesBackToTheModelThatMadeTheData) {
  Campaign c = campaign_on_slope(60);
  Model truth = model_of_slope(), start = truth;
  measure(c, truth, 77);
  start.grounds[0].theta_scale = 0.6;
  start.grounds[0].En50 = 6.0;
  const std::vector<Parameter> free = two_parameters(c, start);
  FitOptions options;
  options.trials = 20;
  options.polish_trials = 40;
  options.rounds = 1;
  const std::vector<bool> rows = fitting_rows(c);
  const Fit fit = fit_parameters(c, start, free, rows, options);
  ObserveOptions other;
  other.seed = 5;
  const double before = score(c, observe(c, start, other), rows).total;
  const double after = score(c, observe(c, fit.model, other), rows).total;
  const double best = score(c, observe(c, truth, other), rows).total;
  EXPECT_LT(after, before - 0.05);
  EXPECT_LT(after, best + 0.02);
  const Uncertainty u = uncertainty_of({c, start, free, rows}, options, {1, 200}, fit);
  for (std::size_t i = 0; i < 2; ++i) {
    const double sd = std::log(u.intervals[i].high / u.intervals[i].low) / (2.0 * 1.96);
    EXPECT_LT(std::abs(std::log(free[i].get(fit.model) / free[i].get(truth))), 5.0 * sd) << free[i].key;
    EXPECT_LT(sd, 1.0) << free[i].key;
  }
  EXPECT_NEAR(u.correlation(0, 0), 1.0, 1e-12);

  options.threads = 1;
  const Fit again = fit_parameters(c, start, free, rows, options);
  EXPECT_EQ(again.z, fit.z);
  EXPECT_EQ(again.objective, fit.objective);
}

/// A parameter that the data cannot see keeps its prior: no confident number.
TEST(Calibrate, WhatTheDataDoNotSeeIsNotIdentifiable) {
  Campaign c = campaign_on_slope(40);
  const Model start = model_of_slope();
  measure(c, start, 78);
  std::vector<Parameter> free = two_parameters(c, start);
  free[1].get = [](const Model&) { return 3.0; };
  free[1].set = [](Model&, double) {};  // moves nothing
  FitOptions options;
  options.trials = 20;
  options.polish_trials = 40;
  options.starts = 1;
  options.rounds = 1;
  const std::vector<bool> rows = fitting_rows(c);
  const Fit fit = fit_parameters(c, start, free, rows, options);
  const Uncertainty u = uncertainty_of({c, start, free, rows}, options, {1, 300}, fit);
  EXPECT_TRUE(u.identifiable[0]);
  EXPECT_FALSE(u.identifiable[1]);
}

TEST(Calibrate, EndsWhenTold) {
  Campaign c = campaign_on_slope(12);
  measure(c, model_of_slope(), 3);
  const std::vector<Parameter> free = two_parameters(c, model_of_slope());
  FitOptions options;
  options.trials = 10;
  int calls = 0;
  options.proceed = [&](double) { return ++calls < 5; };
  EXPECT_TRUE(fit_parameters(c, model_of_slope(), free, fitting_rows(c), options).interrupted);
  EXPECT_EQ(calls, 5);
}

}  // namespace
}  // namespace talus::test
