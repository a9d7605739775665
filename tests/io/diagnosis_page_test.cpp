#include "talus/io/reports/diagnosis_page.hpp"

#include <gtest/gtest.h>

#include "io/reports/diagnosis_summary.hpp"
#include "talus/io/reports/sites_report.hpp"

namespace talus::io {
namespace {

DiagnosisRound round_with(const char* effect, double p_of_place) {
  DiagnosisRound round;
  round.effect = effect;
  round.p_value = p_of_place;
  FamilyTest place, day;
  place.name = "place";
  place.p_value = place.p_corrected = p_of_place;
  day.name = "day";
  day.p_value = day.p_corrected = 0.9;
  round.families = {place, day};
  return round;
}

/// Two rounds of no effect, in both of which the place has p = 0.2.
DiagnosisRecord record_of(double first_level, double later_level) {
  DiagnosisRecord record;
  record.options.first_level = first_level;
  record.options.later_level = later_level;
  record.diagnosis.rounds = {round_with("none", 0.2), round_with("none", 0.2)};
  record.candidates.resize(2);
  record.rounds.resize(2);
  record.errors.resize(1);
  record.unseen = 0;
  return record;
}

/// The score of a model, two rows of each block.
Score score_of_blocks(std::uint32_t blocks, double each = 0.5) {
  Score score;
  score.groups = {{"stop", each, blocks}, {"speed S1", each, blocks}};
  for (std::uint32_t group = 0; group < 2; ++group)
    for (std::uint32_t block = 0; block < blocks; ++block) score.rows.push_back({group, block, each});
  score.total = each;
  return score;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

bool says(const DiagnosisRecord& record, const std::string& sentence) {
  return summary_html(record).text().find(sentence) != std::string::npos;
}

/// A round is `unexplained` by a family or by a row of the residual table (docs/diagnosis-method.md, "The choice"): the
/// page names the row by which it is.
TEST(DiagnosisPage, NamesTheRowOfTheResidualTableThatIsLeft) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  DiagnosisRound& first = record.diagnosis.rounds.front();
  first.effect = "unexplained";
  first.residual = {{"lateral", "release height", -0.7, 1e-6, 8e-5, 24}, {"runout", "mass", 0.1, 0.6, 1.0, 24}};
  EXPECT_EQ(residual_text(first, 0.01),
            "lateral depends on release height (p 8e-05, corrected for the number of rows)");
  EXPECT_TRUE(says(record,
                   "No family of effects is significant (smallest p 0.2, corrected for their number). But "
                   "lateral depends on release height (p 8e-05, corrected for the number of rows)."));
  EXPECT_EQ(count_of(diagnosis_page(Campaign{}, record), "In the residual table lateral depends on release height"),
            1U);
  first.residual.front().covariate = "spread";
  EXPECT_TRUE(says(record, "But the spread of lateral is not that of the model"));
  first.residual.front().corrected = 0.02;  // no reason for `unexplained`
  EXPECT_EQ(residual_text(first, 0.01), "");
  EXPECT_FALSE(says(record, "But the spread"));
}

/// A family that the data cannot test is said, and what it takes.
TEST(DiagnosisPage, SaysWhatAFamilyWithoutATestNeeds) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  FamilyTest& day = record.diagnosis.rounds.front().families[1];
  EXPECT_FALSE(says(record, "could not be tested"));
  day.p_value = day.p_corrected = kNotGiven;
  day.note = "releases of several days within one group are needed";
  EXPECT_TRUE(
      says(record, "The family day could not be tested: releases of several days within one group are needed."));
  EXPECT_TRUE(says(record, "For the family day releases of several days within one group are needed."));
  EXPECT_FALSE(says(record, "Every effect of the library would have been seen"));
}

/// Half of an amount that there is not is none: such an effect would be shown at all.
TEST(DiagnosisPage, SaysWhatFurtherSpeedsWouldShow) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  record.diagnosis.rounds.back().limits = {{.effect = "air-drag", .with_further_speeds = 2.0},
                                           {.effect = "soft-ground", .amount = 4.0, .with_further_speeds = 1.9},
                                           {.effect = "block-mass", .amount = 4.0, .with_further_speeds = 2.1},
                                           {.effect = "wet-ground"}};
  EXPECT_TRUE(says(record,
                   "Speeds at more screens (12 were assumed): they would show soft-ground at less than half the "
                   "amount and would show a large amount of air-drag, of which these data show none."));
}

/// Where nothing was found nothing was gained: the verdict rests on the blocks that were fitted.
TEST(DiagnosisPage, AsksForMoreBlocksByWhatTheVerdictRestsOn) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  record.errors.resize(2);  // of 24 fitting rows and no held-out ones
  record.errors[0].after.score = score_of_blocks(24);
  record.unseen = 1;
  EXPECT_TRUE(says(record, "More blocks: 24 were fitted."));
  EXPECT_FALSE(says(record, "the gain rests on"));
  record.errors[1].after.blocks = 24;  // half of them left the DEM
  record.errors[1].after.score = score_of_blocks(12);
  record.diagnosis.rounds.front().effect = "soft-ground";
  record.diagnosis.rounds.front().candidates.resize(1);
  EXPECT_TRUE(says(record, "More blocks: the gain rests on 12 of them."));
}

/// Whether the model can be used is said before what the effect gained, which says nothing of that.
TEST(DiagnosisPage, SaysWhetherTheModelPredicts) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  ScoredRows& after = record.errors[0].after;
  after.rows = "holdout";
  after.blocks = 12;
  after.score = after.compared = score_of_blocks(12, 0.8);
  after.climatology = score_of_blocks(12, 1.0);
  record.whole.before = 0.8;
  const auto with_skill = [&](double share, double low) {
    after.skill = {share, {low, share + 0.1}};
    return summary_html(record).text();
  };
  EXPECT_NE(with_skill(0.2, 0.05).find("<b>Yes.</b> On held-out rows: skill 20.0 %"), std::string::npos);
  EXPECT_NE(with_skill(0.2, -0.05).find("<b>Not shown.</b> On held-out rows: skill 20.0 %"), std::string::npos);
  EXPECT_NE(with_skill(-0.2, -0.3).find("<b>No: do not take it for a map.</b> On held-out rows: no skill"),
            std::string::npos);
  EXPECT_NE(with_skill(kNotGiven, kNotGiven).find("It cannot be said."), std::string::npos);
  after.coverage.resize(1);
  after.coverage[0].observable = "runout";
  after.coverage[0].rows = 24;
  after.coverage[0].below[1] = {.count = 7, .expected = {8.0, 16.0}};
  EXPECT_NE(with_skill(0.2, 0.05).find(
                "<b>71 % of 24 held-out blocks ran farther than the model's median (of a right "
                "model 33 to 67 %): the model may stop blocks too early (unsafe)</b>; one right model in twenty"),
            std::string::npos);
}

/// Folds that took the choice of all rows say so: asked for by --quick-folds, or because the diagnosis is costly, with
/// its vertices, the limit and the way out. The same words in the terminal and on the page.
TEST(DiagnosisPage, SaysThatQuickFoldsTookTheChoiceOfAllRows) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  NestedValidation nested;
  nested.folds.count = 2;
  nested.loops = {{8, {}, {"wet-ground"}, {""}}, {8, {}, {"wet-ground"}, {""}}};
  record.diagnosis.nested = nested;
  record.diagnosis.vertices = 3'210'000'000;
  record.options.rules.costly = 2.5;
  const auto expect = [&](const std::string& words, bool said) {
    EXPECT_EQ(repeated_lines(record).find(words) != std::string::npos, said) << words;
    EXPECT_EQ(diagnosis_page(Campaign{}, record).find(words) != std::string::npos, said) << words;
  };
  const std::string choice =
                        "the folds took the effects that all rows chose, and numbers near those of all rows: the "
                        "error has seen the choice",
                    cost = choice +
                           "; the diagnosis of all rows traced 3.2 billion vertices, more than 2.5 "
                           "(--no-quick-folds chooses anew)";
  expect(choice, false);
  EXPECT_NE(repeated_lines(record).find("out of fold (2 folds by block), found: 2 of 2 wet-ground"), std::string::npos);
  record.diagnosis.nested->naming = false;
  expect(cost, true);
  EXPECT_NE(repeated_lines(record).find("out of fold (2 folds by block), given: 2 of 2 wet-ground"), std::string::npos);
  record.options.naming_in_folds = false;  // --quick-folds
  expect(choice, true);
  expect("billion vertices", false);
}

TEST(DiagnosisPage, NamesFamiliesByTheLevelOfTheRound) {
  const std::string depends = "The residual before this round depends on: <b>place</b>",
                    noise = "Nothing is left that differs from noise.";
  const auto page = [](double first, double later) { return diagnosis_page(Campaign{}, record_of(first, later)); };
  EXPECT_EQ(count_of(page(0.05, 0.01), depends), 0U);
  EXPECT_EQ(count_of(page(0.05, 0.01), noise), 2U);
  EXPECT_EQ(count_of(page(0.3, 0.01), depends), 1U);
  EXPECT_EQ(count_of(page(0.3, 0.01), noise), 1U);
  EXPECT_EQ(count_of(page(0.3, 0.3), depends), 2U);
  EXPECT_EQ(count_of(page(0.05, 0.01), "No family of effects is significant"), 1U);
  EXPECT_EQ(count_of(page(0.3, 0.01), "What the ground alone leaves depends on: place (p 0.2), corrected"), 1U);
}

/// A round in which no effect was allowed does not say that none explains what is left.
TEST(DiagnosisPage, SaysWhereNoFurtherEffectWasTried) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  DiagnosisRound& last = record.diagnosis.rounds.back();
  last = round_with("unexplained", 0.001);
  const std::string none = "no effect of the library explains", untried = "no further effect was tried";
  EXPECT_EQ(count_of(diagnosis_page(Campaign{}, record), none), 1U);
  last.tried = false;
  record.diagnosis.stability.fits.resize(1);
  EXPECT_EQ(count_of(diagnosis_page(Campaign{}, record), none), 0U);
  EXPECT_EQ(count_of(diagnosis_page(Campaign{}, record), untried), 1U);
  EXPECT_NE(diagnosis_json(record).find("\"effects_tried\": false"), std::string::npos);
}

/// Where a family is significant and nothing is named, the page does not call it noise.
TEST(DiagnosisPage, ASignificantFamilyIsNoNoise) {
  const std::string noise = "Nothing that these data can show", something = "Something may be missing";
  EXPECT_TRUE(says(record_of(0.05, 0.01), noise));
  EXPECT_FALSE(says(record_of(0.3, 0.01), noise));
  EXPECT_TRUE(says(record_of(0.3, 0.01), something));
}

/// theta_scale on the log scale, a factor of e from its start, within a third of a unit: by hand.
TEST(DiagnosisPage, ShowsTheGroundThatWasFitted) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  record.diagnosis.stability.fits.resize(1);
  Parameter p;
  p.key = "ground.zones.talus.theta_scale";
  p.lower = 0.01, p.upper = 10.0, p.centre = 0.4;
  p.get = [](const Model&) { return 0.147; };
  FittedModel& base = record.diagnosis.base;
  base.free = {p};
  base.z = Eigen::VectorXd::Constant(1, -1.0);
  base.spread = Eigen::MatrixXd::Constant(1, 1, 1.0 / 9.0);
  const std::string page = diagnosis_page(Campaign{}, record);
  EXPECT_EQ(count_of(page,
                     "<td class='b'>ground.zones.talus.theta_scale</td><td>0.4</td><td>0.147</td>"
                     "<td>0.105 to 0.205</td><td>0.147</td>"),
            1U);
  EXPECT_EQ(count_of(page, "One fit of the ground was made"), 1U);
}

TEST(DiagnosisPage, SaysWhereTheFittedNumbersDidNotSettle) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  record.diagnosis.stability.fits.resize(1);
  const auto page_says = [&](const std::string& words) {
    return count_of(diagnosis_page(Campaign{}, record), words) == 1;
  };
  EXPECT_FALSE(page_says("Place and instrument were tested"));
  record.diagnosis.rounds.front().settling = {4, 30.0, 6.2, 1.37};
  EXPECT_TRUE(
      page_says("up to 1.4 standard deviations of the prior from the fit: their score statistic is 6.2, at the fit "
                "30 (in a right model 4 on average)"));
  EXPECT_FALSE(page_says("They did not settle"));
  record.diagnosis.rounds.front().settling = {4, 30.0, 30.0, 0.0};
  EXPECT_TRUE(page_says("They did not settle: these p may be too small"));
  EXPECT_NE(diagnosis_json(record).find("\"farthest_move_sd\": 0.0"), std::string::npos);
}

/// Quick folds leave a block out of the fits, but the effect was chosen with it.
TEST(DiagnosisPage, SaysWhatTheUnseenRowsHaveTakenPartIn) {
  const std::string not_of_choice = "On blocks left out of the fits, but not of the choice of the effect, the error is";
  const std::string no_fit = "On blocks that no fit has seen the error is";
  DiagnosisRecord record = record_of(0.05, 0.01);
  record.whole.before = record.whole.after = 0.6;
  record.errors.front().after.rows = "out-of-fold";
  record.errors.front().after.blocks = 12;
  EXPECT_TRUE(says(record, no_fit));
  record.diagnosis.nested.emplace().naming = false;
  EXPECT_TRUE(says(record, not_of_choice));
  EXPECT_EQ(count_of(diagnosis_page(Campaign{}, record), "(not fitted, but the choice has seen them)"), 1U);
  record.diagnosis.nested->naming = true;
  EXPECT_TRUE(says(record, no_fit));
  EXPECT_EQ(count_of(diagnosis_page(Campaign{}, record), "(never fitted)"), 1U);
  record.diagnosis.nested->naming = false;
  record.diagnosis.rounds.resize(1);  // no effect was chosen
  EXPECT_TRUE(says(record, no_fit));
}

TEST(DiagnosisWarnings, NameWhatACostlyDiagnosisLeftOut) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  EXPECT_TRUE(diagnosis_warnings(record).empty());
  Diagnosis& d = record.diagnosis;
  d.stability.fits.resize(2);
  d.stability.left_out = 3;
  d.rounds.resize(2);
  d.rounds.front().effect = "wet-ground";
  d.ended_early = true;
  const std::string costly =
      ": blocks of this campaign take long (more than 12 billion vertices traced or foreseen; --";
  EXPECT_EQ(diagnosis_warnings(record),
            (std::vector<std::string>{
                "the verdict is that of 2 fits of the ground, not of 5" + costly + "base-fits 5 makes all)",
                "no effect was fitted after wet-ground" + costly + "most-effects 3 fits more)"}));
}

TEST(DiagnosisWarnings, OfFoldsThatSplitGroupsAndOfAModelThatNoFileHolds) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  record.diagnosis.nested.emplace();
  EXPECT_TRUE(diagnosis_warnings(record).empty());
  record.diagnosis.nested->folds.splits_groups = true;
  Grid grid;
  grid.columns = grid.rows = 1;
  record.diagnosis.with_effects.model.zones = Raster<std::uint8_t>(grid, 0);
  const std::vector<std::string> warnings = diagnosis_warnings(record);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].find("the folds split groups"), 0U);
  EXPECT_EQ(warnings[1].find("with_effect.toml is not the whole model"), 0U);
}

TEST(DiagnosisWarnings, OfFewBlocksAndFewTrials) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  BeforeAfter& fitting = record.errors.front();
  fitting.after.blocks = 24;
  EXPECT_TRUE(diagnosis_warnings(record).empty());
  record.options.trials.search = 12;
  ASSERT_EQ(diagnosis_warnings(record).size(), 1U);
  EXPECT_EQ(diagnosis_warnings(record).front().find("fewer trials than by default"), 0U);
  fitting.after.blocks = 6;  // says more
  ASSERT_EQ(diagnosis_warnings(record).size(), 1U);
  EXPECT_EQ(diagnosis_warnings(record).front().find("only 6 blocks are fitted"), 0U);
}

/// A prior holds back a ground that is far from its start: 2 standard deviations of a normal prior are rare (5 %), and
/// in docs/diagnosis-results.md, "Nothing to be found", false alarms are more frequent there.
TEST(DiagnosisWarnings, OfAGroundFarFromItsStart) {
  DiagnosisRecord record = record_of(0.05, 0.01);
  FittedModel& base = record.diagnosis.base;
  base.free.resize(3);
  base.free[0].key = "ground.zones.talus.theta_scale";
  base.free[1].key = "ground.zones.talus.En50";
  base.free[2].key = "ground.zones.rock.Et50";
  base.z = Eigen::Vector3d(-1.4, 1.2, 0.0);
  EXPECT_TRUE(diagnosis_warnings(record).empty());
  base.z = Eigen::Vector3d(-2.04, 1.2, 1.71);
  ASSERT_EQ(diagnosis_warnings(record).size(), 1U);
  EXPECT_EQ(diagnosis_warnings(record).front().find("the fitted ground is far from its start "
                                                    "(ground.zones.talus.theta_scale by 2.0, ground.zones.rock.Et50 "
                                                    "by 1.7 standard deviations of the prior)"),
            0U);
  SitesRecord sites;
  sites.diagnosis.sites.resize(1);
  sites.diagnosis.sites[0].name = "south";
  sites.diagnosis.sites[0].base.free = base.free;
  sites.diagnosis.sites[0].base.z = base.z;
  ASSERT_EQ(sites_warnings(sites).size(), 1U);
  EXPECT_EQ(sites_warnings(sites).front().find("south: the fitted ground is far from its start "
                                               "(ground.zones.talus.theta_scale by 2.0"),
            0U);
}

}  // namespace
}  // namespace talus::io
