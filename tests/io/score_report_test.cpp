#include "talus/io/reports/score_report.hpp"

#include <gtest/gtest.h>

namespace talus::io {
namespace {

/// A group of twelve rows that score `large`, and one of two rows that score `small`.
Score of_two_groups(double large, double small) {
  Score score;
  score.groups = {{"stop", large, 12}, {"speed", small, 2}};
  for (std::uint32_t block = 0; block < 12; ++block) score.rows.push_back({0, block, large + 0.01 * (block % 2)});
  for (std::uint32_t block = 0; block < 2; ++block) score.rows.push_back({1, block, small});
  score.total = 0.5 * (large + small);
  return score;
}

/// The error, the climatology and the skill beside it are all of the same rows.
TEST(InLargeGroups, ErrorClimatologyAndSkillAreOfTheSameRows) {
  ScoredRows rows;
  rows.rows = "holdout";
  rows.score = rows.compared = of_two_groups(0.6, 9.0);
  rows.climatology = of_two_groups(0.8, 1.0);
  std::vector<std::uint32_t> clusters;
  for (std::uint32_t block = 0; block < 12; ++block) clusters.push_back(block);
  const ScoredRows large = in_large_groups(rows, clusters);
  EXPECT_DOUBLE_EQ(large.score.total, 0.6);
  EXPECT_DOUBLE_EQ(large.climatology.total, 0.8);
  EXPECT_NEAR(large.skill.share, 0.25, 0.002) << "1 - 0.6 / 0.8; of all rows the model would have no skill";
  EXPECT_NE(skill_sentence(large).find("0.600 against the climatology's 0.800"), std::string::npos);
}

TEST(InLargeGroups, NothingIsSaidOfSkillWhereNoGroupIsLarge) {
  ScoredRows rows;
  rows.score.groups = {{"speed", 0.4, 2}};
  rows.score.rows = {{0, 0, 0.4}, {0, 1, 0.4}};
  rows.climatology = rows.compared = rows.score;
  rows.skill.share = 0.3;
  EXPECT_EQ(skill_sentence(in_large_groups(rows, std::vector<std::uint32_t>{0, 1})), "");
}

/// Rows that score as the climatology for want of simulated values are no skill of the model, whatever the figures are.
/// A group of two rows weighs as much as one of twelve: the share of the score decides, not the number of rows.
TEST(SkillSentence, IsNotOfAModelThatHardlySimulates) {
  ScoredRows rows;
  rows.rows = "fit";
  rows.score = rows.compared = of_two_groups(0.5, 0.5);
  rows.score.groups[0].unseen = 6;  // half of a group is still told
  rows.climatology = of_two_groups(0.8, 0.8);
  rows.skill.share = 0.3;
  EXPECT_NE(skill_sentence(rows).find("skill 30.0 %"), std::string::npos);
  rows.score.groups[0].unseen = 12;  // nothing of one quantity: the other one may not hide that
  EXPECT_NE(skill_sentence(rows).find("skill cannot be told: 50 % of the score"), std::string::npos);
  rows.score.groups[1].unseen = 1;
  EXPECT_EQ(skill_sentence(rows),
            "fitting rows: skill cannot be told: 75 % of the score is of rows that have too few simulated values and "
            "score as the climatology");
  rows.score.groups[0].unseen = 7;  // the large group alone
  rows.compared = rows.score;
  const std::vector<std::uint32_t> clusters{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  EXPECT_TRUE(std::isnan(in_large_groups(rows, clusters).skill.share));
}

TEST(TailSentence, IsNotOfAModelThatHardlySimulates) {
  ScoredRows rows;
  rows.rows = "holdout";
  rows.tail_begin = 56.0;
  rows.tail = rows.tail_climatology = of_two_groups(0.5, 0.5);
  rows.tail.groups.resize(1);
  rows.tail.groups[0].unseen = 6;
  EXPECT_NE(tail_sentence(rows).find("0.500 against"), std::string::npos) << "a half of twelve rows is told";
  rows.tail.groups[0].unseen = 7;
  EXPECT_EQ(tail_sentence(rows), "held-out rows: run-out beyond 56 m: cannot be told: too few simulated values");
}

TEST(TailSentence, DoubtsASkillWhoseIntervalHoldsZeroOrOfFittedRows) {
  ScoredRows rows;
  rows.rows = "holdout";
  rows.tail_begin = 56.0;
  rows.tail = of_two_groups(0.4, 0.4);
  rows.tail_climatology = of_two_groups(0.5, 0.5);
  rows.tail_skill = {0.2, {0.05, 0.35}};
  EXPECT_EQ(tail_sentence(rows),
            "held-out rows: run-out beyond 56 m: skill 20.0 % (95 %: 5.0 to 35.0 %): 0.400 against the climatology's "
            "0.500");
  rows.fitted = kNotGiven;
  EXPECT_TRUE(tail_sentence(rows).ends_with("; these rows were fitted, which lowers their error without any skill"));
  rows.tail_skill.interval.low = -0.05;
  EXPECT_TRUE(tail_sentence(rows).ends_with("; it may have no skill"));
  rows.tail_skill.share = -0.2;
  EXPECT_TRUE(tail_sentence(rows).ends_with(": no skill"));
}

TEST(ScoreWarnings, OfBlocksThatCameToRestButLeaveInTheModel) {
  ScoredRows rows;
  rows.rows = "fit";
  rows.blocks = 24;
  EXPECT_TRUE(score_warnings(rows).empty());
  rows.leaving = 3;
  ASSERT_EQ(score_warnings(rows).size(), 1U);
  EXPECT_EQ(score_warnings(rows)[0].find("of 3 of 24 fitting blocks more than a quarter of the trials leave the DEM"),
            0U);
  rows.deposits.emplace();
  ASSERT_EQ(score_warnings(rows).size(), 1U);
  EXPECT_EQ(score_warnings(rows)[0].find("more than half of the trials of 3 of 24 fitting mapped blocks leave the DEM"),
            0U);
}

/// Blocks that left the DEM have no place of rest: a model that keeps all of them on it is too short. Unless nobody
/// looked for them, so that the words say "if".
TEST(ScoreWarnings, OfBlocksWithoutAPlaceOfRestThatStayInTheModel) {
  ScoredRows rows;
  rows.rows = "fit";
  rows.blocks = 24;
  rows.leaving_trials = {24, 9, 0.3, 1.0, 2e-9};
  ASSERT_EQ(score_warnings(rows).size(), 1U);
  EXPECT_EQ(score_warnings(rows)[0].find("9 of 24 fitting blocks have no place of rest; if they left the DEM, the "
                                         "ground stops blocks too early (unsafe): by the model 0.3 leave it (p 2e-09)"),
            0U);
  EXPECT_NE(
      judgement_lines(rows).find("by the model 0.3 of 24 blocks leave the DEM, at most 9 did: p 1; if all of them "
                                 "did, p 2e-09; run-outs are compared with trials that stay *\n"),
      std::string::npos);
  rows.leaving_trials = {24, 2, 0.0, 1.0, 1e-5};  // two were not found
  EXPECT_TRUE(score_warnings(rows).empty());
  rows.leaving_trials = {8, 2, 0.0, 1.0, 1e-4};
  EXPECT_TRUE(score_warnings(rows).empty());
  rows.leaving_trials = {8, 3, 0.0, 1.0, 1e-6};
  EXPECT_EQ(score_warnings(rows).size(), 1U);
  rows.leaving_trials = {24, 9, 5.0, 1.0, 0.02};
  EXPECT_TRUE(score_warnings(rows).empty());
  rows.leaving_trials = {24, 24, 0.0, 1.0, 0.0};  // nobody mapped where they stopped
  EXPECT_TRUE(score_warnings(rows).empty());
}

/// The middle run-out alone: its side is what a hazard map hangs on, and the correction for all shares hides it.
TEST(JudgementLines, SayToWhichSideTheMiddleRunOutErrs) {
  ScoredRows rows;
  rows.rows = "holdout";
  rows.coverage.resize(1);
  rows.coverage[0].observable = "runout";
  rows.coverage[0].rows = 20;
  ShareBelow& below = rows.coverage[0].below[1];
  below = {.count = 6, .expected = {6.0, 14.0}};
  EXPECT_EQ(judgement_lines(rows).find("median"), std::string::npos);
  below.count = 5;
  EXPECT_NE(
      judgement_lines(rows).find("75 % of 20 held-out blocks ran farther than the model's median (of a right model "
                                 "30 to 70 %): the model may stop blocks too early (unsafe)\n"),
      std::string::npos);
  below.count = 15;
  EXPECT_NE(judgement_lines(rows).find("75 % of 20 held-out blocks ran less far than the model's median (of a right "
                                       "model 30 to 70 %): the model may let blocks go too far\n"),
            std::string::npos);
}

/// Twelve blocks, all at rest; four crossed S1, with a speed but no jump: nothing of S1 is scored, and that is said.
TEST(Scored, NamesWhatWasMeasuredTooSeldom) {
  Campaign campaign;
  campaign.screens = {{"S1", {}}};
  std::vector<BlockRuns> runs(12);
  for (std::uint32_t b = 0; b < 12; ++b) {
    MeasuredBlock& block = campaign.blocks.emplace_back();
    block.stream = b;
    block.stop = Eigen::Vector2d(b, 0.5 * b);
    block.passages.resize(1);
    if (b < 4) block.passages[0] = Passage{10.0 + b, kNotGiven, kNotGiven};
    runs[b].trials = 20;
    runs[b].x.assign(20, 3.0);
    runs[b].y = runs[b].mass_share = runs[b].x;
    runs[b].screens = {{runs[b].x, runs[b].x, runs[b].x}};
  }
  const ScoredRows rows = scored("fit", campaign, runs, std::vector<bool>(12, true));
  EXPECT_EQ(rows.not_counted, (std::vector<std::string>{"crossed S1 (4 of 12)", "speed S1 (4 of 12)"}));
  EXPECT_EQ(judgement_lines(rows).find("fitting rows: too few, or too much alike, to be scored: "
                                       "crossed S1 (4 of 12), speed S1 (4 of 12) blocks\n"),
            0U);
}

/// Twelve blocks, of six of which no trial comes to rest: their rows score exactly as the climatology and are no skill;
/// with its own value, as in score.py, each is better than that. The other rows hit what was measured.
TEST(Scored, RowsWithoutSimulatedValuesAreNoSkill) {
  Campaign campaign;
  std::vector<BlockRuns> runs(12);
  for (std::uint32_t b = 0; b < 12; ++b) {
    MeasuredBlock& block = campaign.blocks.emplace_back();
    block.stream = b;
    block.stop = Eigen::Vector2d(b * b % 7, b);
    runs[b].trials = 20;
    runs[b].x.assign(20, b < 6 ? kNotGiven : block.stop->x());
    runs[b].y.assign(20, b < 6 ? kNotGiven : block.stop->y());
    runs[b].ends[static_cast<std::size_t>(End::Left)] = b < 6 ? 20 : 0;
  }
  const ScoredRows rows = scored("fit", campaign, runs, std::vector<bool>(12, true));
  double climatology = 0.0;
  for (std::size_t r = 0; r < 12; ++r) {
    climatology += rows.climatology.rows[r].score / 12.0;
    EXPECT_NEAR(rows.compared.rows[r].score, r < 6 ? rows.climatology.rows[r].score : 0.0, 1e-12);
    if (r < 6) EXPECT_LT(rows.score.rows[r].score, rows.climatology.rows[r].score);
  }
  EXPECT_NEAR(rows.skill.share, 1.0 - rows.compared.total / climatology, 1e-12);
}

/// Releases 100 m apart, ways that differ by 2 m at most, and a model that is 20 m off each place of rest: by far
/// nearer than the places of the others, but not than their ways.
TEST(Scored, TheWaysOfTheOthersAreARivalOfTheModel) {
  Campaign campaign;
  std::vector<BlockRuns> runs(12);
  for (std::uint32_t b = 0; b < 12; ++b) {
    MeasuredBlock& block = campaign.blocks.emplace_back();
    block.stream = b;
    block.x = 100.0 * b;
    block.stop = Eigen::Vector2d(block.x + b % 3, 40.0);
    runs[b].trials = 20;
    runs[b].x.assign(20, block.stop->x() + 20.0);
    runs[b].y.assign(20, 40.0);
  }
  const ScoredRows rows = scored("fit", campaign, runs, std::vector<bool>(12, true));
  EXPECT_GT(rows.skill.share, 0.5);
  EXPECT_LT(rows.skill_over_ways.share, 0.0);
  const std::string said = skill_sentence(rows);
  EXPECT_TRUE(said.starts_with("fitting rows: no skill: ")) << said;
  EXPECT_NE(said.find(" of the climatology by release"), std::string::npos) << said;
  EXPECT_NE(score_table({}, {&rows, 1}).find("\nclimatology by release "), std::string::npos);
}

/// Four numbers fitted to two groups, of 12 and of 2 rows, gain 4 x 0.56 (1/12 + 1/2) / 4 = 0.327 on these rows without
/// any skill (Akaike): of a climatology of 0.56 that is 58.3 %. A skill is one only if its interval lies above that.
TEST(SkillSentence, OfFittedRowsTakesWhatTheFitGains) {
  ScoredRows rows;
  rows.rows = "fit";
  rows.blocks = 24;
  rows.score = rows.compared = of_two_groups(0.4, 0.4);
  rows.climatology = of_two_groups(0.56, 0.56);
  rows.skill = {0.286, {0.1, 0.4}};
  EXPECT_EQ(skill_sentence(rows),
            "fitting rows: skill 28.6 % (95 %: 10.0 to 40.0 %): 0.400 against the climatology's 0.560");
  rows.fitted = 4;
  EXPECT_NE(skill_sentence(rows).find("; fitting 4.0 free numbers to these 14 rows gains some 58.3 % on them without "
                                      "any skill; it may have no skill"),
            std::string::npos)
      << skill_sentence(rows);
  EXPECT_NEAR(judged_skill(rows).interval.low, 0.1 - 7.0 / 12.0, 1e-12);
  EXPECT_DOUBLE_EQ(judged_skill(rows).share, 0.286);
  rows.skill.interval.low = 0.59;
  EXPECT_EQ(skill_sentence(rows).find("it may have no skill"), std::string::npos);
  rows.fitted = kNotGiven;  // some numbers, not counted: nothing is sure
  EXPECT_DOUBLE_EQ(judged_skill(rows).interval.low, 0.0);
}

/// The skill that the file of a model gives is that on rows that it has not seen, over the better climatology.
TEST(SkillOfModel, IsThatOnUnseenRows) {
  ScoredRows fitting, unseen;
  fitting.rows = "fit", unseen.rows = "holdout";
  std::vector<std::uint32_t> clusters(12);
  std::iota(clusters.begin(), clusters.end(), 0U);
  fitting.compared = fitting.score = of_two_groups(0.35, 9.0);  // the small group does not count
  fitting.climatology = of_two_groups(0.5, 1.0);
  const auto skill = [&] { return skill_of_model(fitting, unseen, clusters); };
  EXPECT_NEAR(skill().share, 0.3, 0.01) << "there are no unseen rows";
  unseen.compared = unseen.score = of_two_groups(0.55, 0.1);  // its two rows would give it skill
  unseen.climatology = of_two_groups(0.8, 1.0), unseen.ways = of_two_groups(0.5, 1.0);
  EXPECT_NEAR(skill().share, -0.1, 0.01) << "over the better climatology";
  EXPECT_LT(skill().interval.low, skill().share);
  fitting.deposits.emplace();
  EXPECT_TRUE(std::isnan(skill().share)) << "blocks anywhere on the mapped ground are no measure";
}

}  // namespace
}  // namespace talus::io
