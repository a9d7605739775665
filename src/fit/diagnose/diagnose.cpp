#include "talus/fit/diagnose/diagnose.hpp"

#include <algorithm>
#include <cmath>

#include "choice.hpp"
#include "diagnosis_loop.hpp"
#include "effect_fits.hpp"
#include "outer_folds.hpp"
#include "repeated_fits.hpp"
#include "talus/fit/diagnose/candidates.hpp"
#include "talus/fit/diagnose/detection_limits.hpp"
#include "talus/fit/diagnose/families.hpp"

namespace talus {
namespace {

constexpr double kGroundShare = 0.3, kTestShare = 0.05;  // of the time of a diagnosis, roughly: for the progress

/// The work of one diagnosis.
class DiagnosisLoop {
 public:
  DiagnosisLoop(const Campaign& campaign, const DiagnoseOptions& options, const LoopScope& scope)
      : campaign_(campaign),
        scope_(scope),
        rows_(fitting_rows(campaign)),
        streams_(bootstrap_streams(campaign)),
        options_(options),
        rules_(options_.rules),
        fits_(campaign, options_, rows_, [this](double share) { return proceeds(share); }) {
    options_.trials = raised_for_few_blocks(options.trials, count_of_rows(rows_), rules_);
    options_.traced = &traced_;
  }

  Diagnosis run(const Model& start) {
    Diagnosis d;
    d.with_effects = fits_.fit_ground(start, scope_.brief);
    advance(kGroundShare);
    std::vector<std::string> found;
    for (int round = 0; round <= options_.effects_at_most(); ++round) {
      const double level = options_.level_of_round(d.rounds.size());
      d.with_effects = fits_.begin_round(std::move(d.with_effects));
      if (round == 0) d.base = d.with_effects;
      const bool last_round = round == options_.effects_at_most();
      d.ended_early = round > 0 && !last_round && spent();
      d.rounds.push_back(run_round(d.with_effects, found, level, !last_round && !d.ended_early));
      const DiagnosisRound& last = d.rounds.back();
      if (!names_effect(last.effect) || scope_.first_round) break;
      found.push_back(last.effect);
      FittedCandidate& chosen = d.rounds.back().candidates.front();
      if (!scope_.brief) fits_.complete(d.with_effects, chosen);
      d.with_effects = chosen.fitted;
    }
    if (!scope_.brief) compare_limits(d.rounds.back().limits, limits_with_further_screens(d.with_effects, found));
    complete_limits(d.rounds.back().limits, d.rounds.back().families, found);
    if (!found.empty()) d.base = fits_.simulated_anew(std::move(d.base));
    d.trials = options_.trials;
    d.times = fits_.times();
    d.vertices = traced_;
    return d;
  }

 private:
  /// Whether the rounds so far were so costly that no further effect is fitted.
  bool spent() const { return !options_.most_effects && billions(traced_) > rules_.enough; }

  void advance(double share = 0.02) { progress_ = std::min(0.95, progress_ + share); }
  /// @param share  of a fit; only the fit of the ground, the longest, is shown
  bool proceeds(double share = 1.0) {
    if (progress_ == 0.0) ground_ = std::max(ground_, kGroundShare * share);
    return !options_.proceed || options_.proceed(std::max(progress_, ground_));
  }

  std::vector<ResidualRow> residual_of(const FittedModel& fitted) const {
    return residual_table(campaign_, ResidualSpace(campaign_, fitted.runs, rules_), fitted.runs, rows_, rules_);
  }

  ScoreTestOptions test_options() {
    return score_test_options(options_, kFamilies, [this] { return proceeds(); });
  }

  /// Tests at the model that `settled_` then is.
  ScoreTest tested(const FittedModel& base, std::span<const Candidate> candidates) {
    const Timesheet::Phase phase(fits_.times(), "tests");
    SettledTest out =
        settled_test(campaign_, {base.model, base.free, base.z, base.runs}, candidates, rows_, test_options(),
                     [this](const Model& model) { return fits_.observed_in(campaign_, model); });
    settled_ = std::move(out.model);
    return std::move(out.test);
  }

  /// How far `settled_` is from the fit.
  Settling settling_of(const FittedModel& base) const {
    const auto n = static_cast<std::size_t>(base.z.size());
    return {n, settled_.statistic_of_fit, settled_.statistic,
            n > 0 ? (settled_.z - base.z).cwiseAbs().maxCoeff() : 0.0};
  }

  /// The limits that the campaign would have with further screens. They come from the trials of the last round, with
  /// the speeds of the same blocks at these screens. Biases of instruments are those of the present screens.
  std::vector<DetectionLimit> limits_with_further_screens(const FittedModel& base,
                                                          const std::vector<std::string>& found) {
    const Timesheet::Phase phase(fits_.times(), "detection limits");
    const Axis axis = axis_of(campaign_, base.runs);
    const Campaign more = with_further_screens(campaign_, axis, rules_);
    ScoreTestOptions how = test_options();
    how.replicates = 0;
    const auto runs = fits_.observed_in(more, settled_.model);
    const std::vector<Candidate> candidates = candidates_of(campaign_, base.model, base.runs, found, rules_);
    const ScoreTest test = score_test(more, {settled_.model, base.free, settled_.z, runs}, candidates, rows_, how);
    return limits_by_parameter(more, axis, test, candidates, rules_);
  }

  /// @param base   the model with all that was found so far
  /// @param found  effects that it has
  /// @param level  p of the score test below which an effect may be chosen
  /// @param more   whether another effect may be added
  DiagnosisRound run_round(const FittedModel& base, const std::vector<std::string>& found, double level, bool more) {
    DiagnosisRound round;
    round.residual = residual_of(base);
    advance(kTestShare);
    const std::vector<Candidate> candidates = candidates_of(campaign_, base.model, base.runs, found, rules_);
    const ScoreTest test = tested(base, candidates);
    round.settling = settling_of(base);
    round.families = tested_families(base, test, found);
    round.p_value = smallest_corrected(round.families);
    const Axis axis = axis_of(campaign_, base.runs);
    round.limits = detection_limits(campaign_, axis, test, candidates, rules_);
    const bool noise = round.p_value > level;
    if (!more || (noise && !found.empty())) {
      round.tried = noise;
      round.effect = verdict_without_effect(round);
      return round;
    }
    round.candidates.reserve(test.effects.size());
    for (const EffectVerdict& verdict : test.effects) {
      const std::string family = admitted(round.families, verdict, level);
      // The first round fits all effects; later ones fit those that may be chosen, the most significant first.
      const bool all = found.empty() && !scope_.brief;
      if (!all && (family.empty() || round.candidates.size() == rules_.later_fits)) continue;
      advance();
      const EffectVerdict placed = in_better_zone(base, verdict, candidates);
      round.candidates.push_back(fits_.fit_effect(
          base, placed, merged_candidate(campaign_, axis, candidates, placed.best.members, rules_), family));
    }
    const bool few = scope_.brief || !found.empty();
    if (!noise) compete(base, round.candidates, few ? rules_.later_contenders : rules_.contenders);
    choose(base, round, noise);
    return round;
  }

  std::vector<FamilyTest> tested_families(const FittedModel& base, const ScoreTest& test,
                                          const std::vector<std::string>& found) const {
    const Timesheet::Phase phase(fits_.times(), "tests");
    FamilyOptions how;
    how.replicates = options_.replicates(kFamilies);
    how.seed = options_.seed;
    how.rules = rules_;
    how.level = options_.level_of_round(found.size());
    return test_families({campaign_, ResidualSpace(campaign_, base.runs, rules_), base.runs, rows_, test, found}, how);
  }

  /// The family by which an effect may be chosen; empty: it may not. Where the test of the family does not rest on the
  /// score tests of its members, all of them may; else those that are significant themselves.
  static std::string admitted(std::span<const FamilyTest> families, const EffectVerdict& verdict, double level) {
    const FamilyTest* family = admitting(families, verdict.effect, level);
    return family != nullptr && (family->own_test || verdict.p_value < level) ? family->name : "";
  }

  /// The test, which is linear, may find a strong effect in the wrong zone. Where the second best zone is significant
  /// too, some amounts of the effect in each decide between them.
  EffectVerdict in_better_zone(const FittedModel& base, const EffectVerdict& verdict,
                               const std::vector<Candidate>& candidates) const {
    EffectVerdict placed = verdict;
    if (verdict.second.members.empty() || verdict.second.p_value > options_.later_level) return placed;
    const Candidate& first = candidates[verdict.best.members.front()];
    const Candidate& second = candidates[verdict.second.members.front()];
    const bool in_zone = first.where == "everywhere" || first.where.starts_with("zone ");
    if (in_zone &&
        fits_.least_objective(base, verdict.second, second) < fits_.least_objective(base, verdict.best, first))
      placed.best = verdict.second;
    return placed;
  }

  /// Continues the fits of the candidates that may be chosen and gain most, then those that may still win with more
  /// trials, and cross-validates what is left. In the first round the fit of the base has been as long before.
  void compete(const FittedModel& base, std::vector<FittedCandidate>& candidates, std::size_t most) {
    std::vector<FittedCandidate*> contenders;
    for (FittedCandidate& c : candidates)
      if (!c.family.empty() && c.refined) contenders.push_back(&c);
    drop_losers(contenders, most, -rules_.unfinished);
    for (FittedCandidate* c : contenders) {
      advance();
      fits_.continue_fit(base, *c);
    }
    drop_losers(contenders, most, rules_.half_way * rules_.worth_naming * base.objective.total);
    if (scope_.brief) return cross_validate(base, contenders);
    for (FittedCandidate* c : contenders) {
      advance();
      fits_.continue_with_more_trials(base, *c);
    }
    cross_validate(base, contenders);
  }

  void cross_validate(const FittedModel& base, std::span<FittedCandidate* const> contenders) const {
    if (contenders.empty()) return;
    const std::vector<Score> before = fits_.cross_validated(base);
    for (FittedCandidate* c : contenders) set_cross_validated(*c, before, fits_.cross_validated(c->fitted), streams_);
  }

  /// Keeps at most `most` contenders, those with the largest net gains. Each gains at least `least` and may still win.
  void drop_losers(std::vector<FittedCandidate*>& contenders, std::size_t most, double least) const {
    if (contenders.empty()) return;
    std::stable_sort(contenders.begin(), contenders.end(),
                     [](const FittedCandidate* a, const FittedCandidate* b) { return a->net_gain() > b->net_gain(); });
    contenders.resize(std::min(contenders.size(), most));
    const Score& best = contenders.front()->fitted.objective;
    const auto behind = [&](const Score& own) { return difference(best, own, streams_).interval.low; };
    std::erase_if(contenders, [&](const FittedCandidate* c) {
      return c->gain < least || behind(c->fitted.objective) > rules_.unfinished;
    });
  }

  /// The verdict of a round that names no effect: "unexplained" where a family or a row of the residual table is
  /// significant at the stricter level, else "none".
  std::string verdict_without_effect(const DiagnosisRound& round) const {
    const bool in_table = !round.residual.empty() && round.residual.front().corrected < options_.later_level;
    return in_table || round.p_value <= options_.later_level ? "unexplained" : "none";
  }

  void choose(const FittedModel& base, DiagnosisRound& round, bool noise) const {
    const Choice choice(base.objective, rules_, streams_);
    choice.rank(round.candidates);
    if (!noise) choice.name_in(round, [&](const FittedCandidate& c) { return fits_.confirmation(base, c); });
    if (!names_effect(round.effect)) round.effect = verdict_without_effect(round);
  }

  const Campaign& campaign_;
  const LoopScope& scope_;
  std::vector<bool> rows_;
  std::vector<std::uint32_t> streams_;
  DiagnoseOptions options_;
  const DiagnosisRules& rules_;
  TracedVertices traced_{0};
  EffectFits fits_;
  SettledModel settled_;  // where the last score test was made
  double progress_ = 0.0, ground_ = 0.0;
};

}  // namespace

int DiagnoseOptions::replicates(std::size_t families) const {
  const double rarest = std::min(first_level / 5.0, later_level) / static_cast<double>(families);
  return std::max(2000, static_cast<int>(std::ceil(1.0 / rarest)));
}

TrialsPerBlock raised_for_few_blocks(TrialsPerBlock trials, std::size_t blocks, const DiagnosisRules& rules) {
  const double more = std::clamp(rules.many_blocks / static_cast<double>(blocks), 1.0, rules.most_of_one);
  for (std::uint32_t* count : {&trials.search, &trials.test, &trials.compare})
    *count = std::max(rules.fewest_of_one, static_cast<std::uint32_t>(std::lround(more * *count)));
  return trials;
}

Diagnosis run_loop(const Campaign& campaign, const Model& start, const DiagnoseOptions& options,
                   const LoopScope& scope) {
  return DiagnosisLoop(campaign, options, scope).run(start);
}

Diagnosis diagnose(const Campaign& campaign, const Model& start, const DiagnoseOptions& options) {
  if (options.nested)
    require_fitting_rows(campaign, outer_folds(campaign, fitting_rows(campaign), options.outer_folds, options.seed));
  DiagnosisWork work(options);
  Diagnosis d = repeated_diagnosis(campaign, start, work);
  if (options.nested) {
    const Timesheet::Phase phase(d.times, "folds");
    d.nested = nested_validation(campaign, start, work, d);
  }
  return d;
}

}  // namespace talus
