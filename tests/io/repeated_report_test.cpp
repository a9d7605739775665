#include "io/reports/repeated_report.hpp"

#include <gtest/gtest.h>

#include "support/campaigns.hpp"
#include "talus/fit/score/intervals.hpp"

namespace talus::io {
namespace {

FittedCandidate candidate_of(const char* effect, bool with_ground) {
  FittedCandidate candidate;
  candidate.effect = effect;
  candidate.with_ground = with_ground;
  return candidate;
}

/// An effect that changes nothing gains nothing: whether its ground was refitted to the other folds, or held, so that
/// it has seen the rows.
TEST(JudgeNested, AnEffectThatChangesNothingGainsNothing) {
  Campaign c = talus::test::campaign_on_slope(24);
  talus::test::measure(c, talus::test::model_of_slope(), 77);
  ObserveOptions how;
  how.trials = 20;
  Model rougher = talus::test::model_of_slope();
  rougher.grounds[0].theta_scale *= 2.0;
  DiagnosisRecord record;
  record.diagnosis.rounds.resize(1);
  record.diagnosis.rounds[0].candidates = {candidate_of("refitted", true), candidate_of("held", false)};
  record.evidence.resize(2);
  record.clusters = clusters_of(c);
  NestedValidation nested;
  nested.folds.count = 2;
  for (std::size_t b = 0; b < c.blocks.size(); ++b)
    nested.folds.fold_of.push_back(c.blocks[b].holdout ? kNoFold : static_cast<std::uint32_t>(b % 2));
  nested.held = observe(c, talus::test::model_of_slope(), how);
  nested.ground = nested.base = nested.found = observe(c, rougher, how);
  nested.candidates = {nested.ground, nested.held};
  record.diagnosis.nested = nested;
  judge_nested(c, record);
  const Json evidence = evidence_of(record);
  ASSERT_EQ(evidence.size(), 5U);  // climatology, ground, what was found, the two
  for (std::size_t i = 3; i < 5; ++i) {
    const Json& judged = evidence[i].at("out-of-fold");
    EXPECT_EQ(judged.at("reduction"), 0.0) << evidence[i].at("model");
    EXPECT_EQ(judged.at("nats_gained"), 0.0);
    EXPECT_EQ(judged.at("ground_error"), judged.at("error"));
    EXPECT_EQ(judged.at("ground_log_score"), judged.at("log_score"));
  }
  EXPECT_NE(evidence[3].at("out-of-fold").at("error"), evidence[4].at("out-of-fold").at("error"));
}

}  // namespace
}  // namespace talus::io
