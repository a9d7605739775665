#include "talus/fit/calibrate/calibrate.hpp"

#include <Eigen/Cholesky>

#include "fit/calibrate/local_model.hpp"
#include "support/campaigns.hpp"
#include "talus/base/error.hpp"
#include "talus/fit/calibrate/quadratic.hpp"
#include "talus/fit/calibrate/uncertainty.hpp"

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
  EXPECT_THROW(ground_parameters(c, start, std::vector<std::string>{"phi"}, {false}), InputError);
}

/// A search by factors does not leave 0: it would be one around another start.
TEST(Parameters, AStartOfZeroIsRefused) {
  const Campaign c = campaign_on_slope(1);
  Model start = model_of_slope();
  EXPECT_NO_THROW(check_start(two_parameters(c, start), start));
  start.grounds[0].theta_scale = 0.0;
  EXPECT_THROW(check_start(two_parameters(c, start), start), InputError);
}

/// A quadratic is found exactly from places without noise.
TEST(QuadraticFit, ExactForAQuadratic) {
  Numbers numbers(2);
  const Eigen::Vector3d g(0.3, -1.0, 2.0);
  Eigen::Matrix3d h;
  h << 4.0, 1.0, 0.0, 1.0, 3.0, -0.5, 0.0, -0.5, 2.0;
  Eigen::MatrixXd places(3, 40), values(40, 1);
  for (Eigen::Index i = 0; i < 40; ++i) {
    const Eigen::Vector3d u = numbers.vector(1.0);
    places.col(i) = u;
    values(i, 0) = 5.0 + g.dot(u) + 0.5 * u.dot(h * u);
  }
  const QuadraticFit fit(places, Eigen::VectorXd::Ones(40), {0.0, 0.0});
  const Eigen::VectorXd c = fit.coefficients(values);
  EXPECT_LT((fit.gradient(c) - g).norm(), 1e-6);
  EXPECT_LT((fit.curvature(c) - h).norm(), 1e-6);
  const Eigen::Vector3d wide = Eigen::Vector3d::Constant(10.0);
  EXPECT_NEAR(fit.coefficients_used(), 10.0, 1e-6);  // 1 + 3 + 6: no ridge holds any back
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
  const QuadraticFit fit(places, Eigen::VectorXd::Ones(5), {0.0, 0.0});
  EXPECT_EQ(fit.curvature(fit.coefficients(values))(0, 0), 0.0);
}

/// The same bowl for every block, seen from a centre that is neither its minimum nor zero: the step leads to the
/// minimum, within the trust region and the bounds.
TEST(LocalModel, StepsToTheMinimumOfABowl) {
  const Campaign c = campaign_on_slope(6);
  const Model start = model_of_slope();
  const std::vector<Parameter> free = two_parameters(c, start);
  const std::vector<bool> rows = fitting_rows(c);
  const FitProblem problem{c, start, free, rows};
  FitOptions options;
  options.prior_weight = 0.0;
  const Eigen::Vector2d minimum(0.9, -0.5);
  Eigen::Matrix2d h;
  h << 3.0, 1.0, 1.0, 2.0;
  const Eigen::Matrix2d spread = 0.04 * Eigen::Matrix2d::Identity();
  Fit fit;
  fit.z = Eigen::Vector2d(0.7, -0.4);
  fit.score.groups = {{"stop", 1.0, 6}};
  for (std::uint32_t block = 0; block < 6; ++block) fit.score.rows.push_back({0, block, 1.0});
  for (const Eigen::VectorXd& z : LocalModel::design(problem, 1, fit.z, spread, 60, 0)) {
    const double value = 0.5 + 0.5 * (z - minimum).dot(h * (z - minimum));
    fit.evaluations.push_back({z, Eigen::VectorXd::Constant(6, value), options.trials, value});
  }
  const LocalModel model(problem, options, fit, spread);
  EXPECT_LT((model.step(spread) - minimum).norm(), 1e-4);
  EXPECT_LT(model.noise(), 1e-4);
  const std::vector<double> some{1.0, 0.0, 1.0, 0.0, 0.0, 2.0};
  EXPECT_LT((model.optimum(some, spread) - minimum).norm(), 1e-4);
  const Eigen::Matrix2d narrow = 1e-4 * Eigen::Matrix2d::Identity();  // two standard deviations: 0.02
  EXPECT_NEAR(model.step(narrow).x(), 0.72, 1e-9);
}

/// The noise is that of FitOptions::trials: totals of four times the trials have half of it.
TEST(LocalModel, TheNoiseIsThatOfTheTrialsAskedFor) {
  const Campaign c = campaign_on_slope(6);
  const Model start = model_of_slope();
  const std::vector<Parameter> free = two_parameters(c, start);
  const std::vector<bool> rows = fitting_rows(c);
  const FitProblem problem{c, start, free, rows};
  const FitOptions options;
  const Eigen::Matrix2d spread = 0.04 * Eigen::Matrix2d::Identity();
  std::mt19937 draws(1);
  for (const std::uint32_t more : {1U, 4U}) {
    std::normal_distribution<double> noise(0.0, 0.02 / std::sqrt(static_cast<double>(more)));
    Fit fit;
    fit.z = Eigen::Vector2d(0.7, -0.4);
    fit.score.groups = {{"stop", 1.0, 6}};
    for (std::uint32_t block = 0; block < 6; ++block) fit.score.rows.push_back({0, block, 1.0});
    for (const Eigen::VectorXd& z : LocalModel::design(problem, 1, fit.z, spread, 400, 0)) {
      const double value = 0.5 + (z - fit.z).squaredNorm() + noise(draws);
      fit.evaluations.push_back({z, Eigen::VectorXd::Constant(6, value), more * options.trials, value});
    }
    EXPECT_NEAR(LocalModel(problem, options, fit, spread).noise(), 0.02, 0.004)
        << more;  // some 200 count: 5 %, four times
  }
}

/// Slope, curvature and the weight of the prior come from the blocks that count. For n blocks the optimum is the
/// minimum of k (z - 0.8)^2 + w / n z^2, with k the mean over these n.
TEST(LocalModel, AFoldHasItsOwnCurvatureAndPrior) {
  const Campaign c = campaign_on_slope(6);
  const Model start = model_of_slope();
  const std::vector<Parameter> free{two_parameters(c, start).front()};
  const std::vector<bool> rows = fitting_rows(c);  // all but 2 and 5
  const FitProblem problem{c, start, free, rows};
  FitOptions options;
  options.prior_weight = 0.028;
  const Eigen::MatrixXd spread = Eigen::MatrixXd::Constant(1, 1, 0.25);
  Fit fit;
  fit.z = Eigen::VectorXd::Constant(1, 0.5);
  fit.score.groups = {{"stop", 1.0, 4}};
  for (const std::uint32_t block : {0U, 1U, 3U, 4U}) fit.score.rows.push_back({0, block, 1.0});
  for (const Eigen::VectorXd& z : LocalModel::design(problem, 1, fit.z, spread, 40, 0)) {
    Eigen::VectorXd values(4);
    for (Eigen::Index row = 0; row < 4; ++row) values[row] = (row == 0 ? 0.1 : 0.3) * std::pow(z[0] - 0.8, 2.0);
    fit.evaluations.push_back({z, values, options.trials, 0.0});
  }
  const LocalModel model(problem, options, fit, spread);
  const std::vector<double> first{1.0, 0.0, 1.0, 0.0, 0.0, 1.0}, all(6, 1.0);  // held-out blocks count for nothing
  EXPECT_NEAR(model.optimum(first, spread)[0], 0.8 * 0.1 / (0.1 + 0.028), 1e-3);
  EXPECT_NEAR(model.optimum(all, spread)[0], 0.8 * 0.25 / (0.25 + 0.028 / 4.0), 1e-3);
}

/// Two groups: thirty rows with their minimum at 1 and ten with theirs at 0. The optimum follows from the weights of
/// the groups, for those of a fit and for equal ones.
TEST(LocalModel, GroupsPullByTheirWeights) {
  const Campaign c = campaign_on_slope(30);
  const Model start = model_of_slope();
  const std::vector<Parameter> free{two_parameters(c, start).front()};
  const std::vector<bool> rows = fitting_rows(c);
  const FitProblem problem{c, start, free, rows};
  FitOptions options;
  options.prior_weight = 0.0;
  const Eigen::MatrixXd spread = Eigen::MatrixXd::Constant(1, 1, 0.25);
  Fit fit;
  fit.z = Eigen::VectorXd::Constant(1, 0.5);
  fit.score.groups = {{"stop", 1.0, 30}, {"speed S", 1.0, 10}};
  for (std::uint32_t row = 0; row < 40; ++row) fit.score.rows.push_back({row / 30, row % 30, 1.0});
  for (const Eigen::VectorXd& z : LocalModel::design(problem, 1, fit.z, spread, 40, 0)) {
    Eigen::VectorXd values(40);
    for (Eigen::Index row = 0; row < 40; ++row) values[row] = std::pow(z[0] - (row < 30 ? 1.0 : 0.0), 2.0);
    fit.evaluations.push_back({z, values, options.trials, 0.0});
  }
  EXPECT_NEAR(LocalModel(problem, options, fit, spread).step(spread)[0], 0.5, 1e-4);
  fit.score = weigh_groups(fit.score);  // 30/40 and 10/20
  EXPECT_NEAR(LocalModel(problem, options, fit, spread).step(spread)[0], 0.6, 1e-4);
}

/// The objective is the score with its groups weighed, plus the prior: here 40 stops and few crossings.
TEST(Evaluate, IsTheWeighedScoreAndThePrior) {
  Campaign c = campaign_on_slope(60);
  const Model start = model_of_slope();
  measure(c, start, 77);
  for (std::size_t b = 12; b < 60; ++b)
    for (auto& passage : c.blocks[b].passages) passage.reset();
  const std::vector<Parameter> free = two_parameters(c, start);
  const std::vector<bool> rows = fitting_rows(c);
  FitOptions options;
  const Eigen::Vector2d z(0.5, -0.25);
  const Evaluation e = evaluate({c, start, free, rows}, options, z, {40});
  const ObserveOptions how{40, options.seed, 0, options.threads, rows, {}};
  const Score plain = score(c, observe(c, model_at(start, free, z), how), rows, fewest_simulated_of(40));
  const double prior = 0.28 / static_cast<double>(std::count(rows.begin(), rows.end(), true)) * 0.3125;  // sum of z^2
  double sum = 0.0, weights = 0.0;
  for (const GroupScore& g : plain.groups)
    sum += g.rows / (g.rows + 10.0) * g.score, weights += g.rows / (g.rows + 10.0);
  ASSERT_GT(plain.groups.size(), 1U);
  EXPECT_NEAR(e.objective, sum / weights + prior, 1e-12);
  EXPECT_GT(std::abs(e.objective - prior - plain.total), 1e-4);  // not the plain mean
  options.starts = options.rounds = 0;
  const Fit fit = fit_parameters(c, start, free, rows, options);
  for (const GroupScore& g : fit.score.groups) EXPECT_DOUBLE_EQ(g.weight, g.rows / (g.rows + 10.0));
}

/// A later fit uses trials that no known evaluation has used, whatever the numbers of trials were.
TEST(Calibrate, LaterPlacesHaveRandomNumbersOfTheirOwn) {
  EXPECT_EQ(LocalModel::trials_of(7, 24), LocalModel::kDesigns + 168);
  std::vector<Evaluation> known(10, {Eigen::Vector2d::Zero(), {}, 48, 0.0});
  EXPECT_EQ(LocalModel::first_unused(known, 24), 20U);
  known.push_back({Eigen::Vector2d::Zero(), {}, 25, 0.0});
  EXPECT_EQ(LocalModel::first_unused(known, 24), 22U);  // 505 trials
  EXPECT_EQ(LocalModel::first_unused({}, 24), 0U);
}

/// A row needs values of a tenth of the trials, and of at least two.
TEST(FewestSimulated, ATenthOfTheTrials) {
  EXPECT_EQ(fewest_simulated_of(10), 2U);
  EXPECT_EQ(fewest_simulated_of(24), 3U);
  EXPECT_EQ(fewest_simulated_of(100), 10U);
  EXPECT_EQ(fewest_simulated_of(1000), 10U);
}

/// Data of a known model: a fit that starts elsewhere lowers the error nearly as far as the truth does, and is the same
/// for any number of threads.
TEST(Calibrate, ComesBackToTheModelThatMadeTheData) {
  Campaign c = campaign_on_slope(60);
  Model truth = model_of_slope(), start = truth;
  measure(c, truth, 77);
  start.grounds[0].theta_scale = 0.6;
  start.grounds[0].En50 = 6.0;
  const std::vector<Parameter> free = two_parameters(c, start);
  FitOptions options;
  options.trials = 20;
  options.comparison_trials = 40;
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

  options.threads = 1;
  const Fit again = fit_parameters(c, start, free, rows, options);
  EXPECT_EQ(again.z, fit.z);
  EXPECT_EQ(again.objective, fit.objective);
}

/// The interval of a fit holds the truth and is narrower than the prior, whose sd is 1: in the median of three
/// campaigns, as the quadratic model of a fit this short is now and then far off. (Of 32 such campaigns one has an
/// interval wider than the prior, and of their 64 errors three are above 3 of its standard deviations.)
TEST(Calibrate, TheIntervalHoldsTheTruth) {
  std::array<std::vector<double>, 2> sds, errors;
  for (const std::uint64_t seed : {77U, 78U, 79U}) {
    Campaign c = campaign_on_slope(60);
    Model truth = model_of_slope(), start = truth;
    measure(c, truth, seed);
    start.grounds[0].theta_scale = 0.6;
    start.grounds[0].En50 = 6.0;
    const std::vector<Parameter> free = two_parameters(c, start);
    FitOptions options;
    options.trials = 20;
    options.comparison_trials = 40;
    options.rounds = 1;
    const std::vector<bool> rows = fitting_rows(c);
    const Fit fit = fit_parameters(c, start, free, rows, options);
    const Uncertainty u = uncertainty_of({c, start, free, rows}, options, {1, 200}, fit);
    for (std::size_t i = 0; i < 2; ++i) {
      sds[i].push_back(std::log(u.intervals[i].high / u.intervals[i].low) / (2.0 * 1.96));
      errors[i].push_back(std::abs(std::log(free[i].get(fit.model) / free[i].get(truth))) / sds[i].back());
    }
    EXPECT_NEAR(u.correlation(0, 0), 1.0, 1e-12);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    std::ranges::sort(sds[i]);
    std::ranges::sort(errors[i]);
    EXPECT_LT(sds[i][1], 1.0);
    EXPECT_LT(errors[i][1], 3.0);
  }
}

/// Intervals of a short fit from one start.
Uncertainty of_short_fit(const Campaign& c, const Model& start, const std::vector<Parameter>& free) {
  FitOptions options;
  options.trials = 20;
  options.comparison_trials = 40;
  options.starts = 1;
  options.rounds = 1;
  const std::vector<bool> rows = fitting_rows(c);
  return uncertainty_of({c, start, free, rows}, options, {1, 300}, fit_parameters(c, start, free, rows, options));
}

/// A parameter without influence on the data keeps its prior and is called not identifiable.
TEST(Calibrate, WhatTheDataDoNotSeeIsNotIdentifiable) {
  Campaign c = campaign_on_slope(40);
  const Model start = model_of_slope();
  measure(c, start, 78);
  std::vector<Parameter> free = two_parameters(c, start);
  free[1].get = [](const Model&) { return 3.0; };
  free[1].set = [](Model&, double) {};  // moves nothing
  const Uncertainty u = of_short_fit(c, start, free);
  EXPECT_TRUE(u.identifiable[0]);
  EXPECT_FALSE(u.identifiable[1]);
}

/// The truth lies beyond the bound of the search: the interval ends there, and does not pass for one of the data.
TEST(Calibrate, AnIntervalThatEndsAtTheBoundIsSaidTo) {
  Campaign c = campaign_on_slope(40);
  const Model truth = model_of_slope();
  measure(c, truth, 79);
  Model start = truth;
  start.grounds[0].theta_scale *= std::exp(-2.7);  // the search goes up by a factor of e^2.5
  const std::vector<Parameter> free = two_parameters(c, start);
  const Uncertainty u = of_short_fit(c, start, free);
  EXPECT_TRUE(u.at_bound[0]);
  EXPECT_NEAR(u.intervals[0].high, truth.grounds[0].theta_scale * std::exp(-0.2), 1e-9);
  EXPECT_FALSE(u.at_bound[1]);
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

/// Variances 1/4, 4 (beyond the prior) and 0: one number to three quarters, none, and one whole.
TEST(EffectiveNumbers, CountWhatThePriorDoesNotHold) {
  Uncertainty uncertainty;
  uncertainty.draws = Eigen::MatrixXd::Zero(1000, 3);
  for (Eigen::Index k = 0; k < 1000; ++k) {
    uncertainty.draws(k, 0) = 3.0 + (k % 2 == 0 ? 0.5 : -0.5);
    uncertainty.draws(k, 1) = k % 2 == 0 ? 2.0 : -2.0;
  }
  EXPECT_NEAR(effective_numbers(uncertainty), 1.75, 0.25 / 999.0 + 1e-12);
  EXPECT_EQ(effective_numbers({}), 0.0);
}

}  // namespace
}  // namespace talus::test
