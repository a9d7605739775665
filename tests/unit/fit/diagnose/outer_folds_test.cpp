#include "fit/diagnose/outer_folds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/campaigns.hpp"
#include "talus/base/error.hpp"
#include "talus/fit/diagnose/diagnose.hpp"
#include "talus/fit/diagnose/several_sites.hpp"
#include "talus/fit/score/fair_scores.hpp"

namespace talus::test {
namespace {

std::vector<std::size_t> sizes_of(const OuterFolds& folds) {
  std::vector<std::size_t> sizes(folds.count, 0);
  for (const std::uint32_t fold : folds.fold_of)
    if (fold != kNoFold) ++sizes.at(fold);
  return sizes;
}

TEST(OuterFolds, EveryFittingBlockIsLeftOutOnceAndNoOther) {
  const Campaign c = campaign_on_slope(45);
  const OuterFolds folds = outer_folds(c, fitting_rows(c), 5, 1);
  EXPECT_FALSE(folds.by_group);
  EXPECT_FALSE(folds.splits_groups) << "there are none";
  EXPECT_EQ(sizes_of(folds), std::vector<std::size_t>(5, 6));
  for (std::size_t b = 0; b < 45; ++b) EXPECT_EQ(folds.fold_of[b] == kNoFold, c.blocks[b].holdout);
}

TEST(OuterFolds, GoByTheNamesNotByTheOrder) {
  Campaign c = campaign_on_slope(45);
  const OuterFolds first = outer_folds(c, fitting_rows(c), 5, 1);
  std::ranges::reverse(c.blocks);
  std::vector<std::uint32_t> turned = outer_folds(c, fitting_rows(c), 5, 1).fold_of;
  std::ranges::reverse(turned);
  EXPECT_EQ(turned, first.fold_of);
  EXPECT_NE(outer_folds(c, fitting_rows(c), 5, 2).fold_of, turned);
}

TEST(OuterFolds, WholeGroupsWhereThereAreEnough) {
  Campaign c = campaign_on_slope(45);
  for (std::size_t b = 0; b < 45; ++b) c.blocks[b].group = "site " + std::to_string(b % 7);
  const OuterFolds folds = outer_folds(c, fitting_rows(c), 5, 1);
  EXPECT_TRUE(folds.by_group);
  for (std::size_t a = 0; a < 45; ++a)
    for (std::size_t b = 0; b < 45; ++b)
      if (!c.blocks[a].holdout && !c.blocks[b].holdout && c.blocks[a].group == c.blocks[b].group)
        EXPECT_EQ(folds.fold_of[a], folds.fold_of[b]);
  const std::vector<std::size_t> sizes = sizes_of(folds);
  EXPECT_GT(*std::ranges::min_element(sizes), 0U);
  for (std::size_t b = 0; b < 45; ++b) c.blocks[b].group = "site " + std::to_string(b % 4);
  EXPECT_FALSE(folds.splits_groups);
  EXPECT_FALSE(outer_folds(c, fitting_rows(c), 5, 1).by_group) << "four groups are no five folds";
  EXPECT_TRUE(outer_folds(c, fitting_rows(c), 5, 1).splits_groups);
  EXPECT_FALSE(outer_folds(c, fitting_rows(c), 4, 1).splits_groups);
  for (std::size_t b = 0; b < 45; ++b) c.blocks[b].group = b < 30 ? "one" : "site " + std::to_string(b);
  EXPECT_FALSE(outer_folds(c, fitting_rows(c), 5, 1).by_group) << "without the largest, too few are left";
  c.blocks[0].group.clear();
  EXPECT_FALSE(outer_folds(c, fitting_rows(c), 2, 1).by_group);
}

TEST(OuterFolds, TooFewMeasurementsAreAnErrorBeforeTheWork) {
  Campaign c = campaign_on_slope(45);
  measure(c, model_of_slope(), 5);
  const OuterFolds folds = outer_folds(c, fitting_rows(c), 5, 1);
  EXPECT_NO_THROW(require_fitting_rows(c, folds));
  int left = 0;
  for (MeasuredBlock& b : c.blocks) {
    b.passages[0].reset();
    if (b.stop && !b.holdout && ++left > 5) b.stop.reset();  // five stops: four without one of their folds
  }
  EXPECT_THROW(require_fitting_rows(c, folds), InputError);
}

/// Options of two folds that fit one number of the ground and test what is left, with few trials.
DiagnoseOptions two_folds() {
  DiagnoseOptions options;
  options.keys = {"theta_scale"};
  options.trials = {20, 20, 20};
  options.rules.most_of_one = 1.0;  // no more trials because the blocks are few
  options.rules.arrangements = 100;
  options.most_effects = 0;
  options.nested = true;
  options.base_fits = 1;
  options.threads = 1;
  options.outer_folds = 2;
  return options;
}

/// Whether two simulations end at the same places.
bool same(const BlockRuns& a, const BlockRuns& b) {
  const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return a.trials == b.trials && std::ranges::equal(a.x, b.x, equal) && std::ranges::equal(a.y, b.y, equal);
}

/// Mean speed at the first screen of the simulated fitting blocks of a fold [m/s].
double speed_of_fold(const std::vector<BlockRuns>& runs, const OuterFolds& folds, std::uint32_t fold) {
  double sum = 0.0, count = 0.0;
  for (std::size_t b = 0; b < runs.size(); ++b) {
    if (folds.fold_of[b] != fold) continue;
    for (const double speed : runs[b].screens[0].speed)
      if (!std::isnan(speed)) sum += speed, ++count;
  }
  return sum / count;
}

/// What a fold predicts of its blocks does not hang on what was measured of them, bit by bit.
TEST(Nested, AFoldNeverSeesItsOwnRows) {
  Campaign c = campaign_on_slope(24);
  measure(c, model_of_slope(), 77);
  const DiagnoseOptions options = two_folds();
  const OuterFolds folds = outer_folds(c, fitting_rows(c), 2, options.seed);
  const NestedValidation first = *diagnose(c, model_of_slope(), options).nested;
  for (std::size_t b = 0; b < c.blocks.size(); ++b) {
    if (folds.fold_of[b] != 0) continue;
    if (c.blocks[b].stop) *c.blocks[b].stop += Eigen::Vector2d(50.0, 20.0);
    if (c.blocks[b].passages[0]) c.blocks[b].passages[0]->speed *= 3.0;
  }
  const NestedValidation second = *diagnose(c, model_of_slope(), options).nested;
  bool others_differ = false;
  for (std::size_t b = 0; b < c.blocks.size(); ++b)
    for (std::uint32_t t = 0; t < first.base[b].trials; ++t) {
      const double x = first.base[b].x[t], y = second.base[b].x[t];
      if (folds.fold_of[b] == 0) EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y)));
      if (folds.fold_of[b] == 1) others_differ |= x != y && !std::isnan(x) && !std::isnan(y);
    }
  EXPECT_TRUE(others_differ) << "the other fold is fitted to what was changed";
}

/// Folds that do not choose take the effects of all rows and refit the numbers. One fold was measured on smoother
/// ground than the other: refitted to the other one, the blocks of the rough fold are faster than on the ground fitted
/// to both, and those of the smooth fold slower.
TEST(Nested, QuickFoldsRefitTheNumbersToTheOtherRows) {
  Campaign c = campaign_on_slope(24);
  DiagnoseOptions options = two_folds();
  options.naming_in_folds = false;
  const OuterFolds folds = outer_folds(c, fitting_rows(c), 2, options.seed);
  Campaign smooth = c;
  Model smoother = model_of_slope();
  smoother.grounds[0].theta_scale *= 0.6;
  measure(c, model_of_slope(), 77);
  measure(smooth, smoother, 77);
  for (std::size_t b = 0; b < c.blocks.size(); ++b)
    if (folds.fold_of[b] == 1) c.blocks[b] = smooth.blocks[b];
  const Diagnosis d = diagnose(c, model_of_slope(), options);
  ASSERT_TRUE(d.nested);
  EXPECT_FALSE(d.nested->naming);
  ASSERT_EQ(d.nested->loops.size(), 2U);
  for (const OuterFold& loop : d.nested->loops) {
    EXPECT_EQ(loop.effects.front(), d.rounds.front().effect);
    EXPECT_TRUE(std::isnan(loop.p_value)) << "nothing was tested without the fold";
  }
  EXPECT_GT(speed_of_fold(d.nested->base, folds, 0), speed_of_fold(d.base.runs, folds, 0) + 0.1);
  EXPECT_LT(speed_of_fold(d.nested->base, folds, 1), speed_of_fold(d.base.runs, folds, 1) - 0.1);
}

/// On the first of three days the ground was wet, which no ground of all days says. The effect that all rows choose
/// predicts the blocks of each fold better than the ground alone.
TEST(Nested, AnEffectThatIsThereLowersTheErrorOutOfQuickFolds) {
  Campaign c = slope_campaign(15);
  Model truth = model_of_slope();
  truth.effects.wet_ground = {.softening = 2.0, .drag = 2.0, .days = {1}, .where = {}};
  measure(c, truth, 77);
  DiagnoseOptions options = two_folds();
  options.naming_in_folds = false;
  options.most_effects.reset();
  options.rules.enough = 0.0;  // after the first effect the rest is tested, and no other is fitted
  const Diagnosis d = diagnose(c, model_of_slope(), options);
  ASSERT_TRUE(d.nested);
  ASSERT_EQ(d.rounds.front().effect, "wet-ground");
  ASSERT_EQ(d.rounds.size(), 2U);
  EXPECT_TRUE(d.ended_early);
  EXPECT_TRUE(d.rounds.back().candidates.empty());
  EXPECT_FALSE(d.rounds.back().families.empty());
  for (const OuterFold& loop : d.nested->loops) EXPECT_EQ(loop.effects, std::vector<std::string>{"wet-ground"});
  const auto error = [&](const std::vector<BlockRuns>& runs) {
    return score(c, runs, fitting_rows(c), {ScoreRule::Fair, kFewestSimulated, d.nested->folds.fold_of}).total;
  };
  EXPECT_LT(error(d.nested->found), 0.9 * error(d.nested->base));
  // The ground that was held with other effects has seen every fold: they are compared with it, in the same trials.
  EXPECT_FALSE(std::ranges::all_of(d.rounds.front().candidates, &FittedCandidate::with_ground));
  ObserveOptions how;
  how.trials = d.nested->trials;
  how.seed = options.seed + 1;
  const std::vector<BlockRuns> of_all_rows = observe(c, d.base.model, how);
  ASSERT_EQ(d.nested->held.size(), c.blocks.size());
  for (std::size_t b = 0; b < c.blocks.size(); ++b) EXPECT_TRUE(same(d.nested->held[b], of_all_rows[b]));
}

/// A costly diagnosis does not repeat its choice, and makes one fit of the ground, or as many as it is asked for. The
/// cost counts vertices, whatever the threads.
TEST(Nested, ACostlyDiagnosisHasQuickFoldsAndFewBaseFits) {
  Campaign c = campaign_on_slope(24);
  measure(c, model_of_slope(), 77);
  DiagnoseOptions options = two_folds();
  options.base_fits.reset();
  options.rules.enough = 0.0;
  const Diagnosis cheap = diagnose(c, model_of_slope(), options);
  EXPECT_TRUE(cheap.nested->naming);
  EXPECT_EQ(cheap.stability.fits.size(), 1U);
  EXPECT_EQ(cheap.stability.left_out, 4);
  EXPECT_GT(cheap.vertices, 16U * 20U * 20U) << "some vertices for each trajectory";
  options.rules.costly = 1e-9 * static_cast<double>(cheap.vertices - 1);
  options.threads = 3;
  options.base_fits = 2;
  const Diagnosis costly = diagnose(c, model_of_slope(), options);
  EXPECT_EQ(costly.stability.fits.size(), 2U);
  EXPECT_EQ(costly.stability.left_out, 0);
  EXPECT_EQ(costly.vertices, cheap.vertices);
  EXPECT_FALSE(costly.nested->naming);
}

/// Folds that are too many for a site are not made, and the diagnosis says so.
TEST(Nested, ASiteOfTooFewRowsIsNamed) {
  std::array<Campaign, 2> c{campaign_on_slope(24), campaign_on_slope(12)};
  for (std::size_t i = 0; i < 2; ++i) measure(c[i], model_of_slope(), 77 + i);
  const std::vector<Site> sites{{"one", &c[0]}, {"two", &c[1]}};
  give_own_streams(sites);
  DiagnoseOptions options = two_folds();
  options.outer_folds = 5;
  const SitesDiagnosis d = diagnose_sites(sites, std::vector<Model>(2, model_of_slope()), options);
  EXPECT_EQ(d.not_nested, "two: cross-validation in 5 folds needs at least 10 fitting rows, not 8");
  EXPECT_TRUE(d.nested.empty());
}

/// The folds of one number are left out at all sites at once: what one site measured of its fold does not reach the
/// other site either. Bit by bit.
TEST(Nested, NoSiteSeesAFoldOfAnother) {
  std::array<Campaign, 2> c{campaign_on_slope(24), campaign_on_slope(24)};
  for (std::size_t i = 0; i < 2; ++i) measure(c[i], model_of_slope(), 77 + i);
  const std::vector<Site> sites{{"one", &c[0]}, {"two", &c[1]}};
  give_own_streams(sites);
  DiagnoseOptions options = two_folds();
  options.most_effects = 1;
  const std::vector<Model> start(2, model_of_slope());
  const auto nested = [&] { return diagnose_sites(sites, start, options).nested; };
  const std::vector<NestedValidation> first = nested();
  ASSERT_EQ(first.size(), 2U);
  for (std::size_t b = 0; b < c[0].blocks.size(); ++b)
    if (first[0].folds.fold_of[b] == 0 && c[0].blocks[b].stop) *c[0].blocks[b].stop += Eigen::Vector2d(50.0, 20.0);
  const std::vector<NestedValidation> second = nested();
  bool others_differ = false;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(first[i].loops.size(), 2U);
    EXPECT_EQ(first[i].loops[0].blocks + first[i].loops[1].blocks, 16U) << "every fitting block once";
    for (std::size_t b = 0; b < c[i].blocks.size(); ++b) {
      const std::uint32_t fold = first[i].folds.fold_of[b];
      if (fold == 0)
        EXPECT_TRUE(same(first[i].base[b], second[i].base[b]) && same(first[i].found[b], second[i].found[b]));
      if (fold == 1) others_differ |= !same(first[i].base[b], second[i].base[b]);
    }
  }
  EXPECT_TRUE(others_differ) << "the other fold is fitted to what was changed";
}

/// The climatology out of its fold is that of the other folds' measurements.
TEST(Nested, TheClimatologyKnowsNoRowOfItsFold) {
  Campaign c = campaign_on_slope(45);
  measure(c, model_of_slope(), 77);
  const OuterFolds folds = outer_folds(c, fitting_rows(c), 5, 1);
  const Score out = score_of_climatology(c, fitting_rows(c), {ScoreRule::Fair, kFewestSimulated, folds.fold_of});
  std::vector<double> speeds;
  for (const MeasuredBlock& b : c.blocks)
    if (!b.holdout && b.passages[0]) speeds.push_back(b.passages[0]->speed);
  double mean = 0.0, squares = 0.0;
  for (const double v : speeds) mean += v / static_cast<double>(speeds.size());
  for (const double v : speeds) squares += (v - mean) * (v - mean) / static_cast<double>(speeds.size());
  std::size_t compared = 0;
  for (const RowScore& row : out.rows) {
    if (out.groups[row.group].name != "speed S1") continue;
    std::vector<double> others;
    for (std::size_t b = 0; b < c.blocks.size(); ++b)
      if (!c.blocks[b].holdout && c.blocks[b].passages[0] && folds.fold_of[b] != folds.fold_of[row.block])
        others.push_back(c.blocks[b].passages[0]->speed);
    EXPECT_NEAR(row.score, fair_crps(others, c.blocks[row.block].passages[0]->speed) / std::sqrt(squares), 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 10U);
}

TEST(Stability, VerdictsThatDifferAreUndecided) {
  Stability s;
  for (const char* effect : {"none", "block-shape", "block-shape", "block-mass", "block-shape"})
    s.fits.push_back({1, effect, "", 0.01 * static_cast<double>(1 + s.fits.size()), {}});
  EXPECT_EQ(verdicts_of(s), (std::vector<std::string>{"block-shape", "none", "block-mass"}));
  EXPECT_EQ(undecided_text(s), "undecided between block-shape, none and block-mass");
  EXPECT_EQ(p_range_of(s).low, 0.01);
  EXPECT_EQ(p_range_of(s).high, 0.05);
  EXPECT_EQ(places_text(s), "");
  for (BaseFitVerdict& fit : s.fits) fit.effect = "none";
  EXPECT_EQ(undecided_text(s), "");
  EXPECT_EQ(places_text(s), "");
  for (std::size_t i = 0; i < 5; ++i)
    s.fits[i].effect = "soft-ground", s.fits[i].where = i % 2 == 0 ? "forest" : "meadow";
  EXPECT_EQ(undecided_text(s), "");
  EXPECT_EQ(places_text(s), "3 of 5 forest, 2 of 5 meadow");
}

}  // namespace
}  // namespace talus::test
