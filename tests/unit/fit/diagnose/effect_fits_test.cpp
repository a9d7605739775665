#include "fit/diagnose/effect_fits.hpp"

#include <gtest/gtest.h>

#include "support/campaigns.hpp"

namespace talus::test {
namespace {

TEST(Trials, AreSharedOutAmongFewBlocks) {
  const TrialsPerBlock many = shared_out({24, 100, 200}, 144);
  EXPECT_EQ(many.search, 24U);  // never fewer than was asked for
  EXPECT_EQ(many.test, 100U);
  EXPECT_EQ(many.compare, 200U);
  const TrialsPerBlock third = shared_out({24, 100, 200}, 24);  // 72 / 24 = 3 times as many
  EXPECT_EQ(third.search, 72U);
  EXPECT_EQ(third.test, 300U);
  EXPECT_EQ(third.compare, 600U);
  EXPECT_EQ(shared_out({24, 100, 200}, 5).search, 96U) << "four times at most";
}

TEST(EffectFits, ALongerFitIsTakenWhereItIsBetterAndTeachesWhereItIsNot) {
  Fitted fitted, longer;
  fitted.objective.total = 0.5;
  fitted.z = Eigen::VectorXd::Constant(1, 1.0);
  fitted.tried.resize(1);
  longer = fitted;
  longer.z[0] = 2.0;
  longer.tried.resize(3);
  longer.objective.total = 0.4;
  EXPECT_EQ(EffectFits::better(fitted, longer).z[0], 2.0);
  longer.objective.total = 0.6;
  const Fitted kept = EffectFits::better(fitted, longer);
  EXPECT_EQ(kept.z[0], 1.0);
  EXPECT_EQ(kept.objective.total, 0.5);
  EXPECT_EQ(kept.tried.size(), 3U);
}

/// A fit whose ground is half as rough again as the one that was fitted to the data, with as much tried around it.
Fitted too_rough(const Campaign& campaign, const std::vector<bool>& rows, Fitted fitted) {
  const Eigen::VectorXd aside = Eigen::VectorXd::Constant(1, std::log(1.5) / fitted.free[0].sd);
  fitted.z += aside;
  fitted.model = model_at(fitted.model, fitted.free, fitted.z);
  for (Evaluation& e : fitted.tried) e.z += aside;  // its quadratic model then has its minimum there, too
  fitted.fitting = observe(campaign, fitted.model, {50, 1, 0, 0, rows, {}});
  fitted.score = score(campaign, fitted.fitting, rows);
  fitted.objective = weigh_groups(fitted.score);
  return fitted;
}

TEST(EffectFits, WhatIsNoBetterIsNotConfirmed) {
  Campaign campaign = campaign_on_slope(45);
  const Model truth = model_of_slope();
  measure(campaign, truth, 77);
  const std::vector<bool> rows = fitting_rows(campaign);
  DiagnoseOptions options;
  options.keys = {"theta_scale"};
  options.trials = {20, 20, 50};
  EffectFits fits(campaign, options, rows, [](double) { return true; });
  const Fitted good = fits.ground(truth);
  const Fitted bad = too_rough(campaign, rows, good);
  ASSERT_GT(bad.objective.total, good.objective.total);
  EXPECT_EQ(fits.again(good).objective.total, good.objective.total);
  EXPECT_GT(fits.cross_validated(bad), fits.cross_validated(good));
  Trial trial;
  trial.fitted = good;
  EXPECT_TRUE(fits.confirmed(bad, trial, {0.0, 0.0}));
  EXPECT_FALSE(fits.confirmed(bad, trial, {1.0, 0.0})) << "not by so much on the rows that it is fitted to";
  EXPECT_FALSE(fits.confirmed(bad, trial, {0.0, 1.0})) << "nor on those that it has not seen";
  trial.place_price = 1.0;
  EXPECT_FALSE(fits.confirmed(bad, trial, {0.0, 0.0})) << "its place costs more than it gains";
  trial.place_price = 0.0;
  trial.fitted = bad;
  EXPECT_FALSE(fits.confirmed(good, trial, {0.0, 0.0}));
  const Fitted anew = fits.begin_round(good), later = fits.begin_round(good);
  EXPECT_EQ(anew.z, good.z);
  EXPECT_NE(anew.objective.total, good.objective.total) << "luck of its own";
  EXPECT_NE(later.objective.total, anew.objective.total);
}

}  // namespace
}  // namespace talus::test
