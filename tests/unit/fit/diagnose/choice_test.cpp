#include "fit/diagnose/choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace talus::test {
namespace {

/// The objective of one group, with the score of each of its rows.
Score objective(const std::vector<double>& rows) {
  Score score;
  score.total = std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(rows.size());
  score.groups = {{"stop", score.total, static_cast<std::uint32_t>(rows.size())}};
  for (std::size_t i = 0; i < rows.size(); ++i) score.rows.push_back({0, static_cast<std::uint32_t>(i), rows[i]});
  return score;
}

/// A base that is off by 1 at each of 20 blocks, and effects with the gains of the rules: 0.1 and 0.05 are enough.
struct Contest {
  std::vector<std::uint32_t> streams;
  Score base = objective(std::vector<double>(20, 1.0));
  DiagnosisRules rules;
  DiagnosisRound round;

  Contest() {
    for (std::uint32_t i = 0; i < 20; ++i) streams.push_back(i);
    rules.worth_naming = 0.1;
    rules.worth_unseen = 0.05;
    rules.least_amount = 0.2;
  }
  /// @param swing  by which the blocks differ from each other
  void add(const std::string& name, double gain, double unseen, double swing = 0.0) {
    FittedCandidate c;
    c.effect = name;
    c.where = "at " + name;
    c.amount = 1.0;
    c.gain = gain;
    c.cross_validated = unseen;
    std::vector<double> rows;
    for (int i = 0; i < 20; ++i) rows.push_back(1.0 - gain + (i % 2 == 0 ? swing : -swing));
    c.fitted.objective = objective(rows);
    round.candidates.push_back(c);
  }
  Choice choice() const { return {base, rules, streams}; }
  std::vector<std::string> order() const {
    std::vector<std::string> names;
    for (const FittedCandidate& c : round.candidates) names.push_back(c.effect);
    return names;
  }
};

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Choice, RanksThoseThatMayBeNamedByUnseenGainsAndTheOthersByNetGains) {
  Contest contest;
  contest.add("too little unseen", 0.5, 0.04);
  contest.add("good", 0.2, 0.1);
  contest.add("not cross-validated", 0.6, kNotGiven);
  contest.add("best", 0.15, 0.12);
  contest.add("price of its place", 0.4, 0.3);
  contest.round.candidates.back().place_price = 0.26;  // leaves 0.04
  contest.round.candidates.back().price = 0.35;
  contest.add("too little of it", 0.3, 0.3);
  contest.round.candidates.back().amount = 0.2;
  contest.choice().rank(contest.round.candidates);
  EXPECT_THAT(contest.order(), ElementsAre("best", "good", "not cross-validated", "too little unseen",
                                           "too little of it", "price of its place"));
}

TEST(Choice, SharesSumToOneAndGoToTheLowestObjective) {
  Contest contest;
  contest.add("worse", 0.2, 0.1);
  contest.add("better", 0.3, 0.1);
  contest.choice().rank(contest.round.candidates);
  for (const FittedCandidate& c : contest.round.candidates)
    EXPECT_NEAR(c.chosen_share, c.effect == "better" ? 1.0 : 0.0, 1e-9) << c.effect;
}

TEST(Choice, NamesTheFirstThatIsConfirmed) {
  Contest contest;
  contest.add("chance", 0.3, 0.2);
  contest.add("right", 0.25, 0.1);
  contest.choice().rank(contest.round.candidates);
  std::vector<std::string> asked;
  contest.choice().name_in(contest.round, [&](const FittedCandidate& c) {
    asked.push_back(c.effect);
    return c.effect == "right" ? Confirmation{0.1, 0.05} : Confirmation{0.3, 0.04};
  });
  EXPECT_THAT(asked, ElementsAre("chance", "right"));
  EXPECT_EQ(contest.round.effect, "right");
  EXPECT_EQ(contest.round.where, "at right");
  EXPECT_THAT(contest.order(), ElementsAre("right", "chance"));
  EXPECT_EQ(contest.round.candidates[1].confirmation.unseen, 0.04) << "what was asked is kept";
}

TEST(Choice, NamesNoneWhereNoneIsConfirmed) {
  Contest contest;
  contest.add("chance", 0.3, 0.2);
  contest.choice().name_in(contest.round, [](const FittedCandidate&) { return Confirmation{0.09, 0.2}; });
  EXPECT_EQ(contest.round.effect, "none");
  EXPECT_THAT(contest.round.alike, IsEmpty());
}

/// Every block prefers the named effect by 0.05: not alike. Where the blocks differ by 0.5 to both sides, 20 of them
/// cannot tell (standard error 0.11).
TEST(Choice, ListsWhatTheBlocksCannotTellFromIt) {
  for (const double swing : {0.0, 0.5}) {
    Contest contest;
    contest.add("named", 0.3, 0.2);
    contest.add("other", 0.25, 0.1, swing);
    contest.add("not to be named", 0.3, 0.0);
    contest.choice().name_in(contest.round, [](const FittedCandidate&) { return Confirmation{1.0, 1.0}; });
    EXPECT_EQ(contest.round.effect, "named");
    EXPECT_EQ(contest.round.alike, swing > 0.0 ? std::vector<std::string>{"other"} : std::vector<std::string>{});
  }
}

}  // namespace
}  // namespace talus::test
