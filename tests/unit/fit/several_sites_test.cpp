#include "talus/fit/diagnose/several_sites.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fit/calibrate/local_model.hpp"
#include "fit/score/fitting_values.hpp"
#include "support/campaigns.hpp"
#include "talus/base/error.hpp"
#include "talus/fit/calibrate/calibrate.hpp"
#include "talus/fit/diagnose/property_test.hpp"
#include "talus/fit/score/joined_scores.hpp"

namespace talus::test {
namespace {

/// Groups of 1.0 (weight 1) and 3.0 (weight 0.5), and one of 2.0 (weight 1): (1 + 1.5 + 2) / 2.5 = 1.8.
TEST(JoinedScores, MeanOverTheGroupsOfAllSites) {
  Score a, b;
  a.groups = {{"stop", 1.0, 2}, {"mass", 3.0, 1, 0.5}};
  a.rows = {{0, 0, 1.0}, {0, 1, 1.0}, {1, 1, 3.0}};
  b.groups = {{"stop", 2.0, 1}};
  b.rows = {{0, 4, 2.0}};
  const Score all = joined_scores(std::vector<SiteScore>{{"a", a, 3}, {"b", b, 5}});
  EXPECT_DOUBLE_EQ(all.total, 1.8);
  EXPECT_EQ(all.groups[2].name, "b: stop");
  EXPECT_EQ(all.rows[3].group, 2U);
  EXPECT_EQ(all.rows[3].block, 7U);  // after the three of a
  EXPECT_TRUE(std::isnan(joined_scores(std::vector<SiteScore>{{"a", {}, 3}, {"b", {}, 5}}).total));
}

TEST(StreamsOfSites, BlocksOfOneNameHaveRandomNumbersOfTheirOwn) {
  Campaign a = campaign_on_slope(6), b = campaign_on_slope(6);  // b2 and b5 are held out
  a.blocks[0].id = "only here";
  a.blocks[0].stream = stream_of_name(a.blocks[0].id);
  b.blocks[1].holdout = true;
  const std::vector<Site> sites{{"a", &a}, {"b", &b}}, swapped{{"b", &b}, {"a", &a}};
  const auto streams = streams_of_sites(sites), other = streams_of_sites(swapped);
  EXPECT_EQ(streams[0], other[1]);
  EXPECT_EQ(streams[1], other[0]);
  EXPECT_EQ(streams[0][0], stream_of_name("only here"));
  EXPECT_EQ(streams[0][1], stream_of_name("b1")) << "a row that is held out elsewhere changes no fit";
  EXPECT_EQ(streams[1][1], stream_of_name("b/b1"));
  EXPECT_EQ(streams[0][3], stream_of_name("a/b3"));
  EXPECT_EQ(streams[1][3], stream_of_name("b/b3"));
}

std::vector<Parameter> ground_of(const Campaign& c, const Model& start) {
  return ground_parameters(c, start, std::vector<std::string>{"En50", "phi"}, {true});
}

TEST(JointParameters, OneNumberSetsTheModelsOfBoth) {
  const Campaign c = campaign_on_slope(6);
  const Model start = model_of_slope();
  const std::vector<bool> rows = fitting_rows(c);
  const std::vector<std::vector<Parameter>> own{ground_of(c, start), ground_of(c, start)};
  const std::vector<std::string> names{"a", "b"}, share{"phi"};
  const JointParameters joint = joint_parameters(names, own, share);
  ASSERT_EQ(joint.free.size(), 3U);
  EXPECT_EQ(joint.free[0].key, "a: ground.zones.default.En50");
  EXPECT_EQ(joint.free[1].key, "ground.zones.default.phi");
  const FitProblem problem({{"a", c, start, rows, joint.sites[0]}, {"b", c, start, rows, joint.sites[1]}}, joint.free);
  const std::vector<Model> models = problem.models(Eigen::Vector3d(0.5, 0.25, -0.5));
  EXPECT_DOUBLE_EQ(own[0][1].get(models[0]), own[0][1].get(start) + 2.0);  // sd 8 degrees
  EXPECT_DOUBLE_EQ(own[0][1].get(models[1]), own[0][1].get(start) + 2.0);
  EXPECT_NEAR(own[0][0].get(models[0]), own[0][0].get(start) * std::exp(0.5), 1e-12);
  EXPECT_NEAR(own[0][0].get(models[1]), own[0][0].get(start) * std::exp(-0.5), 1e-12);
  EXPECT_LT((problem.start() - Eigen::Vector3d::Zero()).norm(), 1e-12);
}

TEST(JointParameters, WhatCannotBeSharedIsRefused) {
  const Campaign c = campaign_on_slope(6);
  Campaign other = c;
  other.zone_names = {"meadow"};
  const Model start = model_of_slope();
  const std::vector<std::vector<Parameter>> own{ground_of(c, start), ground_of(other, start)};
  const std::vector<std::string> names{"a", "b"}, phi{"phi"}, keys{"En50", "phi"}, unknown{"Et50"};
  EXPECT_THROW(joint_parameters(names, own, phi), InputError) << "no zone of the same name";
  EXPECT_THROW(check_shared(unknown, keys), InputError);
  EXPECT_THROW(check_shared(std::vector<std::string>{"phi", "phi"}, keys), InputError);
  EXPECT_NO_THROW(check_shared(phi, keys));
}

/// A bowl for every block around a minimum of its own: the draws of a fit scatter as the weighted mean of the minima
/// does, sd / sqrt(n + 1). Two copies with a shared number have 2 n blocks; a number of its own stays as uncertain.
struct Bowls {
  Campaign a = campaign_on_slope(30), b = a;
  Model start = model_of_slope();
  std::vector<bool> rows = std::vector<bool>(30, true);
  FitOptions options;
  Eigen::MatrixXd spread;

  double sd_of_draws(const FitProblem& problem, Eigen::Index number, std::size_t copies) {
    options.prior_weight = 0.0;
    const auto n = std::ssize(problem.free);
    spread = 0.25 * Eigen::MatrixXd::Identity(n, n);
    Fit fit;
    fit.z = Eigen::VectorXd::Zero(n);
    for (std::uint32_t copy = 0; copy < copies; ++copy) {
      fit.score.groups.push_back({"stop", 1.0, 30});
      for (std::uint32_t block = 0; block < 30; ++block) fit.score.rows.push_back({copy, 30 * copy + block, 1.0});
    }
    Numbers numbers(3);
    std::vector<double> minima;
    for (int i = 0; i < 30; ++i) minima.push_back(0.4 * numbers.normal());
    for (const Eigen::VectorXd& z : LocalModel::design(problem, 1, fit.z, spread, 80, 0)) {
      Eigen::VectorXd values(std::ssize(fit.score.rows));
      for (Eigen::Index r = 0; r < values.size(); ++r) {
        const double own = n == 2 ? z[r / 30] : z[0];
        values[r] = std::pow(own - minima[static_cast<std::size_t>(r % 30)], 2.0);
      }
      fit.evaluations.push_back({z, values, options.trials, 0.0});
    }
    const LocalModel model(problem, options, fit, spread);
    std::vector<double> draws;
    for (std::uint32_t k = 0; k < 2000; ++k) draws.push_back(model.draw(k)[number]);
    return std::sqrt(variance_of(draws));
  }
};

TEST(JointFit, ASharedNumberOfTwoCopiesHasAnIntervalNarrowerByTheRootOfTwo) {
  Bowls bowls;
  std::vector<Site> sites{{"a", &bowls.a}, {"b", &bowls.b}};
  give_own_streams(sites);
  const std::vector<std::vector<Parameter>> own(
      2, ground_parameters(bowls.a, bowls.start, std::vector<std::string>{"En50"}, {true}));
  const std::vector<std::string> names{"a", "b"};
  const double alone = bowls.sd_of_draws({bowls.a, bowls.start, own[0], bowls.rows}, 0, 1);
  const auto problem_of = [&](const JointParameters& joint) {
    return FitProblem({{"a", bowls.a, bowls.start, bowls.rows, joint.sites[0]},
                       {"b", bowls.b, bowls.start, bowls.rows, joint.sites[1]}},
                      joint.free);
  };
  const JointParameters shared = joint_parameters(names, own, std::vector<std::string>{"En50"});
  const JointParameters apart = joint_parameters(names, own, {});
  // 2000 draws: a ratio of two sds is known to 2.2 %, five standard errors
  EXPECT_NEAR(alone / bowls.sd_of_draws(problem_of(shared), 0, 2), std::sqrt(61.0 / 31.0), 0.16);
  EXPECT_NEAR(alone / bowls.sd_of_draws(problem_of(apart), 1, 2), 1.0, 0.11);
}

/// The objective of two copies is that of one, and its places are those of one: nothing else is in it.
TEST(JointFit, TheObjectiveOfTwoCopiesIsThatOfOne) {
  Campaign a = campaign_on_slope(24);
  const Model start = model_of_slope();
  measure(a, start, 77);
  const std::vector<bool> rows = fitting_rows(a);
  const std::vector<Parameter> free = ground_of(a, start);
  const std::vector<std::vector<Parameter>> own(2, free);
  const JointParameters joint =
      joint_parameters(std::vector<std::string>{"a", "b"}, own, std::vector<std::string>{"En50", "phi"});
  const FitProblem both({{"a", a, start, rows, joint.sites[0]}, {"b", a, start, rows, joint.sites[1]}}, joint.free);
  FitOptions options;
  options.prior_weight = 0.0;
  const Eigen::Vector2d z(0.3, -0.2);
  EXPECT_NEAR(evaluate(both, options, z, {20}).objective, evaluate({a, start, free, rows}, options, z, {20}).objective,
              1e-12);
}

struct Made {
  Campaign campaign;
  std::vector<double> energy;
};

/// Blocks of many shapes and masses at a site of its own; energy falls with log L1/L2 by `slope`.
Made made(Numbers& numbers, const std::string& site, std::size_t n, double slope, double heavier, double further) {
  Made out;
  for (std::size_t i = 0; i < n; ++i) {
    MeasuredBlock b;
    b.id = site + std::to_string(i);
    b.stream = stream_of_name(b.id);
    b.mass = std::exp(heavier + numbers.uniform(-0.7, 0.7));
    b.axes = {numbers.uniform(1.3, 2.0), numbers.uniform(1.0, 1.3), numbers.uniform(0.7, 1.0)};
    out.energy.push_back(further + numbers.normal() - slope * std::log(b.axes.x() / b.axes.y()));
    out.campaign.blocks.push_back(std::move(b));
  }
  return out;
}

double p_of(const Made& a, const Made& b) {
  DiagnosisRules rules;
  rules.arrangements = 400;
  const std::vector<BlockNumbers> both{{a.campaign, a.energy}, {b.campaign, b.energy}};
  return property_test(both, rules, 1).regression.permuted.p_value;
}

/// Sites that differ in mass and in how far all blocks go: 5 % of 400 null pairs, five standard errors. An intercept
/// for both together would call each of them significant.
TEST(PropertyTestOfSites, HasItsSizeThoughSitesDiffer) {
  Numbers numbers(31);
  int alarms = 0;
  for (int set = 0; set < 400; ++set)
    alarms += p_of(made(numbers, "a", 24, 0.0, 5.0, 0.0), made(numbers, "b", 24, 0.0, 8.0, 3.0)) <= 0.05;
  EXPECT_NEAR(alarms / 400.0, 0.05, 5.0 * std::sqrt(0.05 * 0.95 / 400.0));
}

/// Two sites of 24 blocks show an effect as often as one site of 48, and more often than one of 24.
TEST(PropertyTestOfSites, TwoSitesHaveThePowerOfOneTwiceAsLarge) {
  Numbers numbers(32);
  DiagnosisRules rules;
  rules.arrangements = 400;
  int one = 0, two = 0, large = 0;
  for (int set = 0; set < 200; ++set) {
    const Made a = made(numbers, "a", 24, 2.0, 5.0, 0.0), b = made(numbers, "b", 24, 2.0, 8.0, 3.0);
    const Made c = made(numbers, "c", 48, 2.0, 6.0, 0.0);
    one += property_test(a.campaign, a.energy, rules, 1).regression.permuted.p_value <= 0.05;
    large += property_test(c.campaign, c.energy, rules, 1).regression.permuted.p_value <= 0.05;
    two += p_of(a, b) <= 0.05;
  }
  EXPECT_NEAR(two / 200.0, large / 200.0, 5.0 * std::sqrt(2.0 * 0.25 / 200.0));
  EXPECT_GT(two, one + 30);
}

}  // namespace
}  // namespace talus::test
