#include "talus/io/reports/diagnosis_report.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis_parts.hpp"
#include "diagnosis_times.hpp"
#include "evidence.hpp"
#include "limits_report.hpp"
#include "repeated_report.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/fit/diagnose/candidates.hpp"
#include "talus/fit/diagnose/families.hpp"

namespace talus::io {
namespace {

constexpr std::uint32_t kHoldoutTrials = 200;
constexpr double kOpening = 0.97;  // progress when the held-out rows are scored

Json families_of(const DiagnosisRound& round) {
  Json list = Json::array();
  for (const FamilyTest& family : round.families) list.push_back(family_json(family));
  return list;
}

Json candidates_of(const DiagnosisRound& round, const std::vector<HoldoutError>& holdout) {
  Json list = Json::array();
  for (std::size_t i = 0; i < round.candidates.size(); ++i) {
    const FittedCandidate& c = round.candidates[i];
    Json item = effect_json(c);
    item["family"] = c.family.empty() ? family_of(c.effect) : c.family;
    item["may_be_chosen"] = !c.family.empty();
    item["fitted_with_ground"] = c.with_ground;
    item["refined"] = c.refined;
    item["fit"] = json_of(c.fitted.score.total);
    item["holdout"] = json_of(holdout[i].after);
    item["holdout_reduction_ci95"] = json_of(holdout[i].reduction.interval);
    item["statistic"] = json_of(c.statistic);
    item["p_value"] = json_of(c.p_value);
    list.push_back(std::move(item));
  }
  return list;
}

std::vector<BlockRuns> holdout_runs(const Campaign& campaign, const Model& model, const DiagnosisRecord& record) {
  if (record.options.proceed && !record.options.proceed(kOpening)) throw FitInterrupted{};
  ObserveOptions how;
  how.trials = kHoldoutTrials;
  how.seed = record.options.seed + 1;
  how.threads = record.options.threads;
  how.blocks = holdout_rows(campaign);
  return observe(campaign, model, how);
}

HoldoutError error_of(const Score& before, const Score& after, std::span<const std::uint32_t> clusters) {
  if (before.rows.empty() || std::isnan(before.total) || std::isnan(after.total))
    return {before.total, after.total, {}};
  return {before.total, after.total, reduction(before, after, clusters)};
}

/// For an effect, the share of the bootstraps in which it is the best. For `none`, the p-value of the test. For
/// `unexplained`, 1 minus the smallest p-value that shows it. None is a probability of being right.
double probability_of(const DiagnosisRound& round) {
  if (names_effect(round.effect)) return round.candidates.front().chosen_share;
  if (round.effect == "none") return round.p_value;
  return 1.0 - std::min(round.p_value, round.residual.empty() ? 1.0 : round.residual.front().corrected);
}

Json rounds_json(const DiagnosisRecord& record) {
  Json rounds = Json::array();
  for (std::size_t i = 0; i < record.diagnosis.rounds.size(); ++i) {
    const DiagnosisRound& round = record.diagnosis.rounds[i];
    Json turn{{"effect", round.effect}};
    if (names_effect(round.effect)) {
      turn["where"] = round.where;
      turn["indistinguishable_from"] = round.alike;
      turn["holdout"] = {{"before", json_of(record.rounds[i].before)}, {"after", json_of(record.rounds[i].after)}};
    }
    turn["effects_tried"] = round.tried;
    turn["p_value"] = json_of(round.p_value);
    if (const Settling& settling = round.settling; !std::isnan(settling.statistic))
      turn["settling"] = {{"parameters", settling.parameters},
                          {"statistic_of_fit", json_of(settling.statistic_of_fit)},
                          {"statistic", json_of(settling.statistic)},
                          {"farthest_move_sd", json_of(settling.farthest)}};
    if (i > 0) {
      turn["families"] = families_of(round);
      turn["candidates"] = candidates_of(round, record.candidates[i]);
    }
    rounds.push_back(turn);
  }
  return rounds;
}

/// Adds the errors of the first and the last model on unseen rows.
Json with_error(Json json, const HoldoutError& error) {
  json["before"] = json_of(error.before);
  json["after"] = json_of(error.after);
  json["reduction"] = json_of(error.reduction.share);
  json["ci95"] = json_of(error.reduction.interval);
  return json;
}

Json error_json(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  const std::string& rows = record.errors[record.unseen].after.rows;
  return {{"metric", "mean normalised score"},
          {"fit", {{"before", json_of(d.base.score.total)}, {"after", json_of(d.with_effects.score.total)}}},
          {"holdout", with_error({{"rows", rows}}, record.whole)},
          {"headline",
           with_error({{"rows", rows}, {"fewest_rows_of_a_group", kHeadlineRows}, {"left_out", small_groups(record)}},
                      record.headline)}};
}

/// Words for a significant row of the residual table.
std::string misfit_text(const ResidualRow& row) {
  if (row.observable == kLeaving) return "fewer blocks left the DEM than leave it by the model";
  if (row.covariate == "mean" || row.covariate == "spread")
    return "the " + row.covariate + " of " + row.observable + " is not that of the model";
  return row.observable + " depends on " + row.covariate;
}

}  // namespace

void open_holdout(const Campaign& campaign, DiagnosisRecord& record) {
  const std::vector<std::uint32_t> clusters = record.clusters = clusters_of(campaign);
  const std::vector<bool> rows = holdout_rows(campaign), fitting = fitting_rows(campaign);
  const Diagnosis& d = record.diagnosis;
  const auto scored_holdout = [&](const std::vector<BlockRuns>& runs) {
    return scored("holdout", campaign, runs, rows);
  };
  ScoredRows base = scored_holdout(holdout_runs(campaign, d.base.model, record)), last = base;
  record.evidence.resize(d.rounds.front().candidates.size());
  for (const DiagnosisRound& round : d.rounds) {
    record.candidates.emplace_back();
    const Score before = last.score;
    for (std::size_t i = 0; i < round.candidates.size(); ++i) {
      const std::vector<BlockRuns> runs = holdout_runs(campaign, round.candidates[i].fitted.model, record);
      Score after = score(campaign, runs, rows);
      record.candidates.back().push_back(error_of(before, after, clusters));
      if (record.rounds.empty() && !after.rows.empty())
        record.evidence[i].push_back({"holdout", std::move(after),
                                      score(campaign, runs, rows, {ScoreRule::LogDensity, kFewestSimulated, {}}),
                                      base.score, base.log_score});
      if (i == 0 && names_effect(round.effect)) last = scored_holdout(runs);
    }
    record.rounds.push_back(error_of(before, last.score, clusters));
  }
  record.errors.push_back(compared(campaign, scored("fit", campaign, d.base.runs, fitting),
                                   scored("fit", campaign, d.with_effects.runs, fitting)));
  record.errors.back().before.fitted = record.errors.back().after.fitted = kNotGiven;
  const bool held_out = count_of_rows(rows) > 0;
  if (held_out || !d.nested) record.errors.push_back(compared(campaign, std::move(base), std::move(last)));
  if (d.nested) judge_nested(campaign, record);
  const BeforeAfter& unseen = record.errors[record.unseen];
  record.whole = error_of(unseen.before.score, unseen.after.score, clusters);
  record.headline = error_of(of_large_groups(unseen.before.score), of_large_groups(unseen.after.score), clusters);
}

Reduction skill_of_ground(const DiagnosisRecord& record) {
  return skill_of_model(record.errors.front().before, record.errors[record.unseen].before, record.clusters);
}

Reduction skill_of_found(const DiagnosisRecord& record) {
  Reduction skill = skill_of_model(record.errors.front().after, record.errors[record.unseen].after, record.clusters);
  if (choice_has_seen(record)) skill.interval.low = std::min(skill.interval.low, 0.0);
  return skill;
}

std::vector<std::string> small_groups(const DiagnosisRecord& record) {
  std::vector<std::string> names;
  for (const GroupScore& group : record.errors[record.unseen].after.score.groups)
    if (group.rows < kHeadlineRows) names.push_back(group.name + " (" + std::to_string(group.rows) + " rows)");
  return names;
}

std::string residual_text(const DiagnosisRound& round, double level) {
  if (round.residual.empty() || !(round.residual.front().corrected < level)) return "";
  const ResidualRow& row = round.residual.front();
  return misfit_text(row) + " (p " + with_digits(row.corrected, 1) + ", corrected for the number of rows)";
}

std::string diagnosis_json(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  const DiagnosisRound& first = d.rounds.front();
  Json effects = Json::array();
  for (const DiagnosisRound& round : d.rounds)
    if (names_effect(round.effect)) effects.push_back(round.effect);
  if (effects.empty()) effects.push_back(first.effect);
  Json json{{"effect", first.effect},
            {"effects", effects},
            {"verdict", verdict_text(d)},
            {"where", first.where},
            {"probability", json_of(probability_of(first))},
            {"indistinguishable_from", first.alike},
            {"rounds", rounds_json(record)},
            {"ended_early", d.ended_early},
            {"error", error_json(record)},
            {"evidence", evidence_of(record)},
            {"tail", tail_json(record.errors)},
            {"coverage", coverage_json(record.errors)},
            {"families", families_of(first)},
            {"detection_limits", limits_json(d.rounds.back().limits)},
            {"stability", stability_json(d.stability)},
            {"candidates", candidates_of(first, record.candidates.front())},
            {"residual", residual_json(first.residual)},
            {"residual_after", residual_json(d.rounds.back().residual)},
            {"campaign", record.campaign},
            {"surface", {{"value", record.surface}, {"source", record.surface_from}}},
            {"start_model", record.start_name},
            {"seed", record.options.seed},
            {"trials_per_block", trials_json(d.trials)},
            {"seconds", json_of(record.seconds)},
            {"times", times_json(record)},
            {"cut_short",
             {{"most_vertices", record.options.rules.search.most_vertices},
              {"before", json_of(d.base.score.cut_short)},
              {"after", json_of(d.with_effects.score.cut_short)}}},
            {"talus", version()},
            {"command", record.command},
            {"warnings", record.warnings}};
  Json ground = Json::object();
  for (const Parameter& p : d.base.free) ground[p.key] = json_of(p.get(d.base.model));
  json["base_parameters"] = ground;
  if (d.nested) json["nested"] = nested_json(record);
  json["sites"] = Json::array({{{"name", record.campaign},
                                {"p_value", json_of(first.p_value)},
                                {"error", json["error"]},
                                {"families", json["families"]}}});
  json["inputs"] = json_of(record.inputs);
  return json_text(json);
}

}  // namespace talus::io
