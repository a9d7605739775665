#include "fit/diagnose/effect_fits.hpp"

#include <gtest/gtest.h>

#include <map>

#include "fit/diagnose/choice.hpp"
#include "fit/diagnose/joint_fits.hpp"
#include "support/campaigns.hpp"
#include "talus/fit/diagnose/candidates.hpp"
#include "talus/fit/diagnose/diagnose.hpp"

namespace talus::test {
namespace {

TEST(Trials, AreSharedOutAmongFewBlocks) {
  const TrialsPerBlock many = raised_for_few_blocks({24, 100, 200}, 144, {});
  EXPECT_EQ(many.search, 24U);  // never fewer than was asked for
  EXPECT_EQ(many.test, 100U);
  EXPECT_EQ(many.compare, 200U);
  const TrialsPerBlock third = raised_for_few_blocks({24, 100, 200}, 24, {});  // 72 / 24 = 3 times as many
  EXPECT_EQ(third.search, 72U);
  EXPECT_EQ(third.test, 300U);
  EXPECT_EQ(third.compare, 600U);
  EXPECT_EQ(raised_for_few_blocks({24, 100, 200}, 5, {}).search, 96U) << "four times at most";
  EXPECT_EQ(raised_for_few_blocks({10, 100, 200}, 144, {}).search, 20U) << "never fewer than a score needs";
}

TEST(EffectFits, ALongerFitIsTakenWhereItIsBetterAndTeachesWhereItIsNot) {
  FittedModel fitted, longer;
  fitted.objective.total = 0.5;
  fitted.z = Eigen::VectorXd::Constant(1, 1.0);
  fitted.evaluations.resize(1);
  longer = fitted;
  longer.z[0] = 2.0;
  longer.evaluations.resize(3);
  longer.objective.total = 0.4;
  EXPECT_EQ(better_of(fitted, longer).z[0], 2.0);
  longer.objective.total = 0.6;
  const FittedModel kept = better_of(fitted, longer);
  EXPECT_EQ(kept.z[0], 1.0);
  EXPECT_EQ(kept.objective.total, 0.5);
  EXPECT_EQ(kept.evaluations.size(), 3U);
}

/// A fit with the ground made half as rough again, and its evaluations moved with it.
FittedModel too_rough(const Campaign& campaign, const std::vector<bool>& rows, FittedModel fitted) {
  const Eigen::VectorXd aside = Eigen::VectorXd::Constant(1, std::log(1.5) / fitted.free[0].sd);
  fitted.z += aside;
  fitted.model = model_at(fitted.model, fitted.free, fitted.z);
  for (Evaluation& e : fitted.evaluations) e.z += aside;  // its quadratic model then has its minimum there, too
  fitted.runs = observe(campaign, fitted.model, {50, 1, 0, 0, rows, {}});
  fitted.score = score(campaign, fitted.runs, rows);
  fitted.objective = weigh_groups(fitted.score);
  return fitted;
}

/// The slope, measured by its own ground, and fits of one number with few trials.
struct SlopeFits {
  explicit SlopeFits(std::size_t blocks) : campaign(campaign_on_slope(blocks)) {
    measure(campaign, model_of_slope(), 77);
    rows = fitting_rows(campaign);
    options.keys = {"theta_scale"};
    options.trials = {20, 20, 50};
  }
  Campaign campaign;
  std::vector<bool> rows;
  DiagnoseOptions options;
};

TEST(EffectFits, WhatIsNoBetterIsNotConfirmed) {
  const SlopeFits slope(45);
  const Campaign& campaign = slope.campaign;
  EffectFits fits(campaign, slope.options, slope.rows, [](double) { return true; });
  const FittedModel good = fits.fit_ground(model_of_slope());
  const FittedModel bad = too_rough(campaign, slope.rows, good);
  ASSERT_GT(bad.objective.total, good.objective.total);
  EXPECT_EQ(fits.simulated_anew(good).objective.total, good.objective.total);
  EXPECT_LT(mean_difference(fits.cross_validated(bad), fits.cross_validated(good), streams_of(campaign)).mean, 0.0);
  FittedCandidate candidate;
  candidate.fitted = good;
  const Confirmation gains = fits.confirmation(bad, candidate);
  EXPECT_TRUE((LeastGain{0.0, 0.0}).are_in(gains));
  EXPECT_FALSE((LeastGain{1.0, 0.0}).are_in(gains)) << "not by so much on the rows that it is fitted to";
  EXPECT_FALSE((LeastGain{0.0, 1.0}).are_in(gains)) << "nor on those that it has not seen";
  EXPECT_FALSE((LeastGain{0.0, 0.0}).are_in({})) << "nothing was asked for";
  candidate.place_price = 1.0;
  EXPECT_EQ(fits.confirmation(bad, candidate).fitted, gains.fitted) << "the same random numbers";
  EXPECT_NEAR(fits.confirmation(bad, candidate).unseen, gains.unseen - 1.0, 1e-12) << "its place has a price";
  candidate.place_price = 0.0;
  candidate.fitted = bad;
  EXPECT_FALSE((LeastGain{0.0, 0.0}).are_in(fits.confirmation(good, candidate)));
  const FittedModel anew = fits.begin_round(good), later = fits.begin_round(good);
  EXPECT_EQ(anew.z, good.z);
  EXPECT_NE(anew.objective.total, good.objective.total) << "random numbers of its own";
  EXPECT_NE(later.objective.total, anew.objective.total);
}

/// The quadratic model of what was tried before has its minimum at the wrong place here: rounds of it alone stay there.
TEST(EffectFits, AChosenModelFarFromItsOptimumIsBroughtThere) {
  const SlopeFits slope(45);
  const EffectFits fits(slope.campaign, slope.options, slope.rows, [](double) { return true; });
  const FittedModel good = fits.fit_ground(model_of_slope());
  const FittedModel bad = fits.simulated_anew(too_rough(slope.campaign, slope.rows, good));
  FittedCandidate chosen;
  chosen.fitted = bad;
  chosen.parameters = {bad.free[0]};
  chosen.tested = 1;
  fits.complete(bad, chosen);
  const FittedModel& completed = chosen.fitted;
  EXPECT_EQ(chosen.values, std::vector<double>{bad.free[0].get(completed.model)}) << "what is reported";
  EXPECT_EQ(chosen.gain, bad.objective.total - completed.objective.total);
  const auto roughness = [](const FittedModel& fitted) { return fitted.free[0].get(fitted.model); };
  const double truth = good.free[0].get(model_of_slope());
  EXPECT_LT(std::abs(std::log(roughness(completed) / truth)), 0.15);
  ASSERT_NEAR(std::log(roughness(bad) / roughness(good)), std::log(1.5), 1e-9);
  EXPECT_LT(completed.objective.total, bad.objective.total - 0.8 * (bad.objective.total - good.objective.total));
}

TEST(JointFits, AChosenModelFarFromItsOptimumIsBroughtThere) {
  SlopeFits slope(45);
  const EffectFits alone(slope.campaign, slope.options, slope.rows, [](double) { return true; });
  const FittedModel ground = alone.fit_ground(model_of_slope(), true);
  const std::vector<Site> sites{{"one", &slope.campaign}, {"two", &slope.campaign}};
  const std::vector<SiteDiagnosis> both(2, {"one", ground, slope.options.trials, {}});
  JointFits fits(sites, slope.options, [](double) { return true; });
  const JointModel good = fits.begin_round(fits.fit_ground(both));
  const Eigen::VectorXd aside = Eigen::VectorXd::Constant(2, std::log(1.5) / ground.free[0].sd);
  JointModel bad = good;
  bad.z += aside;
  for (Evaluation& e : bad.evaluations) e.z += aside;
  for (std::size_t i = 0; i < 2; ++i)
    bad.models[i] = model_at(bad.models[i], ground.free, bad.z.segment(static_cast<Eigen::Index>(i), 1));
  bad = fits.begin_round(std::move(bad));
  JointCandidate chosen;
  chosen.fitted = bad;
  chosen.parameters = {ground.free[0]};
  chosen.tested = 1;
  fits.complete(bad, chosen);
  const double truth = ground.free[0].get(model_of_slope());
  for (const Model& model : chosen.fitted.models)
    EXPECT_LT(std::abs(std::log(ground.free[0].get(model) / truth)), 0.15);
  EXPECT_NEAR(chosen.gain, bad.objective.total - chosen.fitted.objective.total, 1e-12) << "what is reported";
  EXPECT_LT(chosen.fitted.objective.total, bad.objective.total - 0.8 * (bad.objective.total - good.objective.total));
}

/// The slope with a screen that no simulated block comes to, where speeds were measured.
struct SlopeWithScreenBeyond : SlopeFits {
  explicit SlopeWithScreenBeyond(std::size_t blocks) : SlopeFits(blocks) {
    campaign.screens.push_back({"S2", {{{318.0, 0.0}, {318.0, 140.0}}}});
    Numbers numbers(5);
    for (MeasuredBlock& block : campaign.blocks) {
      block.passages.resize(2);
      block.passages[1] = Passage{numbers.uniform(2.0, 9.0), kNotGiven, kNotGiven};
    }
    rows = fitting_rows(campaign);
    options.rules.folds = static_cast<std::size_t>(std::ranges::count(rows, true));  // each block is a fold
    options.rules.fold_orders = 1;
  }
};

/// Rows of the group that ends in `name`, by block.
std::map<std::uint32_t, double> rows_of(const Score& score, const std::string& name) {
  std::map<std::uint32_t, double> rows;
  for (const RowScore& row : score.rows)
    if (score.groups[row.group].name.ends_with(name)) rows[row.block] = row.score;
  return rows;
}

/// A block that no trial brings to the screen is scored by the speeds of the blocks in other folds. With one block in
/// each fold these are all blocks but itself, as in the climatology.
TEST(EffectFits, ABlockOutOfItsFoldDoesNotKnowItsOwnMeasurement) {
  const SlopeWithScreenBeyond slope(30);
  const auto expected = rows_of(score_of_climatology(slope.campaign, slope.rows), "speed S2");
  ASSERT_EQ(expected.size(), 20U);
  const EffectFits fits(slope.campaign, slope.options, slope.rows, [](double) { return true; });
  const FittedModel ground = fits.fit_ground(model_of_slope(), true);
  EXPECT_EQ(rows_of(fits.cross_validated(ground).front(), "speed S2"), expected);
  EXPECT_EQ(rows_of(ground.objective, "speed S2"), expected) << "nor in what is fitted: it would pay not to get there";
  EXPECT_NE(rows_of(ground.score, "speed S2"), expected) << "in the score it does, as in score.py";
}

TEST(JointFits, ABlockOutOfItsFoldDoesNotKnowItsOwnMeasurement) {
  SlopeWithScreenBeyond slope(30);
  const auto expected = rows_of(score_of_climatology(slope.campaign, slope.rows), "speed S2");
  const EffectFits fits(slope.campaign, slope.options, slope.rows, [](double) { return true; });
  const std::vector<Site> sites{{"one", &slope.campaign}, {"two", &slope.campaign}};
  const FittedModel ground = fits.fit_ground(model_of_slope(), true);
  const SiteDiagnosis alone{"one", ground, slope.options.trials, {}};
  DiagnoseOptions options = slope.options;
  options.rules.folds *= 2;
  const JointFits joint(sites, options, [](double) { return true; });
  const std::vector<SiteDiagnosis> both{alone, alone};
  const Score out_of_fold = joint.cross_validated(joint.fit_ground(both), Judges::Choice).front();
  const auto first = rows_of(out_of_fold, "one: speed S2"), second = rows_of(out_of_fold, "two: speed S2");
  ASSERT_EQ(first.size(), 20U);
  EXPECT_EQ(first, expected);
  ASSERT_EQ(second.size(), expected.size());
  for (const auto& [block, value] : expected) EXPECT_EQ(second.at(block + 30U), value);
}

/// Random speeds at a screen that one trial in twenty comes to. The choice sees a row there from a fifth of its trials
/// on; with more trials it is not more of them, and the speeds do not matter.
TEST(EffectFits, RowsThatTheChoiceLeavesToTheClimatologyDoNotConfirmIt) {
  SlopeFits slope(45);
  Campaign& campaign = slope.campaign;
  std::vector<double> run_out;
  for (const BlockRuns& runs : observe(campaign, model_of_slope(), {50, 1, 0, 0, slope.rows, {}}))
    std::ranges::copy_if(runs.x, std::back_inserter(run_out), [](double x) { return !std::isnan(x); });
  std::ranges::sort(run_out);
  const double far = quantile(run_out, 0.95);
  campaign.screens.push_back({"S2", {{{far, 0.0}, {far, 140.0}}}});
  const auto with_speeds = [&](std::uint64_t seed) {
    Campaign measured = campaign;
    Numbers numbers(seed);
    for (MeasuredBlock& block : measured.blocks) {
      block.passages.resize(2);
      block.passages[1] = Passage{numbers.uniform(2.0, 9.0), kNotGiven, kNotGiven};
    }
    return measured;
  };
  const Campaign one = with_speeds(5), other = with_speeds(6);
  const EffectFits fits(one, slope.options, slope.rows, [](double) { return true; });
  const EffectFits others(other, slope.options, slope.rows, [](double) { return true; });
  FittedCandidate good;
  good.fitted = fits.fit_ground(model_of_slope(), true);
  const FittedModel bad = too_rough(one, slope.rows, good.fitted);
  EXPECT_NEAR(fits.confirmation(bad, good).fitted, others.confirmation(bad, good).fitted, 1e-12);
}

TEST(EffectFits, WhatOnlyHarmsIsNotFitted) {
  const SlopeFits slope(30);
  const Campaign& campaign = slope.campaign;
  EffectFits fits(campaign, slope.options, slope.rows, [](double) { return true; });
  const FittedModel base = fits.begin_round(fits.fit_ground(model_of_slope()));
  const auto list = candidates_of(campaign, base.model, base.runs, {}, {});
  const auto drag = std::ranges::find(list, "vegetation-drag", &Candidate::effect);
  ASSERT_NE(drag, list.end());
  EffectVerdict verdict;
  verdict.effect = drag->effect;
  verdict.best.estimate = Eigen::VectorXd::Constant(1, 4.0);  // much too large
  verdict.best.ground = Eigen::VectorXd::Zero(1);
  const FittedCandidate held = fits.fit_effect(base, verdict, *drag, "");
  EXPECT_FALSE(held.refined);
  EXPECT_EQ(held.gain, 0.0);
  EXPECT_EQ(held.values, std::vector<double>{0.0});
  EXPECT_EQ(held.amount, 0.0);
  EXPECT_FALSE(held.fitted.model.effects.any());
  EXPECT_EQ(held.fitted.score.total, base.score.total);
  const FittedCandidate dropped = fits.fit_effect(base, verdict, *drag, "place");
  EXPECT_FALSE(dropped.refined);
  EXPECT_EQ(dropped.fitted.z.head(1), base.z) << "with the ground as it is";
  EXPECT_EQ(dropped.fitted.free.size(), 2U);
  ASSERT_EQ(fits.times().phases().size(), 3U);  // ground, comparison, fits of vegetation-drag
  EXPECT_EQ(fits.times().phases().back().effect, "vegetation-drag");
}

}  // namespace
}  // namespace talus::test
