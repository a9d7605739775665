#include "talus/fit/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace talus {
namespace {

constexpr std::uint32_t kUnseen = 1'000'000;  // first trial of the luck that no search has seen
constexpr int kFolds = 2;
constexpr std::size_t kThorough = 3;   // of the effects that the test finds most significant
constexpr double kWorthASearch = 0.1;  // p of the score test

/// The work of one diagnosis.
class Diagnosing {
 public:
  Diagnosing(const Campaign& campaign, const DiagnoseOptions& options)
      : campaign_(campaign), options_(options), rows_(fitting_rows(campaign)) {}

  Diagnosis run(const Model& start) {
    Diagnosis d;
    d.base = fit_base(start);
    d.with_effects = d.base;
    std::vector<std::string> found;
    for (int round = 0; round <= options_.most_effects; ++round) {
      const double level = round == 0 ? options_.first_level : options_.later_level;
      d.rounds.push_back(turn(d.with_effects, found, level, round < options_.most_effects));
      const Round& last = d.rounds.back();
      if (last.effect == "none" || last.effect == "unexplained") break;
      found.push_back(last.effect);
      polish(d.rounds.back().trials.front());
      d.with_effects = d.rounds.back().trials.front().fitted;
    }
    d.residual_after = residual_of(d.with_effects);
    return d;
  }

 private:
  void say(double share, const std::string& what) const {
    if (options_.proceed && !options_.proceed(share, what)) throw DiagnosisInterrupted{};
  }

  ObserveOptions observing(std::uint32_t trials) const {
    return {trials, options_.seed, kUnseen, options_.threads, rows_, {}};
  }

  FitOptions fitting(int evaluations) const {
    FitOptions how;
    how.trials = options_.search_trials;
    how.polish_trials = 2 * options_.search_trials;
    how.starts = evaluations > 0 ? 1 : 2;
    how.evaluations = evaluations;
    how.rounds = evaluations > 0 ? 1 : 3;
    how.seed = options_.seed;
    how.threads = options_.threads;
    how.proceed = [this](double) {
      say(progress_, what_);
      return true;
    };
    return how;
  }

  /// On luck that the search has not seen.
  Fitted finish(Fit&& fit, std::vector<Parameter> free) const {
    if (fit.interrupted) throw DiagnosisInterrupted{};
    Fitted out{std::move(fit.model), std::move(free), std::move(fit.z), {}, {}};
    out.fitting = observe(campaign_, out.model, observing(options_.final_trials));
    out.score = score(campaign_, out.fitting, rows_);
    return out;
  }

  Fitted fit_base(const Model& start) {
    progress_ = 0.0, what_ = "fitting the ground";
    const std::vector<BlockRuns> runs = observe(campaign_, start, observing(options_.search_trials));
    std::vector<Parameter> free = ground_parameters(campaign_, start, options_.keys, touched_zones(campaign_, runs));
    Fit fit = fit_parameters(campaign_, start, free, rows_, fitting(0));
    return finish(std::move(fit), std::move(free));
  }

  std::vector<ResidualRow> residual_of(const Fitted& fitted) const {
    return residual_table(campaign_, ResidualSpace(campaign_, fitted.fitting), rows_);
  }

  /// The candidate of a verdict: bands that were joined become one.
  Candidate resolved(const std::vector<Candidate>& list, const Verdict& verdict, const Axis& axis) const {
    const Candidate& first = list[verdict.candidate];
    if (first.effect != "undeclared-zone") return first;
    return band(campaign_, axis, first.from, list[verdict.candidate + verdict.joined - 1].to);
  }

  /// Where the search of a candidate starts: the estimate of the score test, kept within reason.
  static Eigen::VectorXd start_of(const Candidate& candidate, const Verdict& verdict) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidate.parameters.size()));
    for (Eigen::Index i = 0; i < verdict.estimate.size(); ++i) {
      const Parameter& p = candidate.parameters[static_cast<std::size_t>(i)];
      const double low = p.lower >= 0.0 ? 0.3 : -2.0;
      z[i] = kNoticed * std::clamp(verdict.estimate[i], low, 4.0);
    }
    return z;
  }

  /// The base with its own parameters moved as the score test expects them to when the candidate comes in.
  static Model moved_along(const Fitted& base, const Candidate& candidate, const Verdict& verdict) {
    const Eigen::VectorXd start = start_of(candidate, verdict) / kNoticed;
    const double share = std::clamp(start[0] / std::max(1e-9, std::abs(verdict.estimate[0])), 0.0, 1.0);
    const Eigen::VectorXd z = base.z + (share * verdict.ground).cwiseMax(-1.0).cwiseMin(1.0);
    return model_at(base.model, base.free, z);
  }

  /// @param thorough  a longer search
  Trial try_effect(const Fitted& base, const EffectVerdict& verdict, const Candidate& candidate, bool thorough) const {
    Trial trial;
    trial.effect = candidate.effect;
    trial.where = candidate.where;
    trial.p_value = verdict.p_value;
    trial.parameters = candidate.parameters;
    trial.joint = verdict.p_value < kWorthASearch;
    std::vector<Parameter> free = trial.joint ? base.free : std::vector<Parameter>{};
    free.insert(free.end(), candidate.parameters.begin(), candidate.parameters.end());
    const Model start = with(trial.joint ? moved_along(base, candidate, verdict.best) : base.model, candidate,
                             start_of(candidate, verdict.best));
    FitOptions how = fitting((thorough ? 6 : 3) * static_cast<int>(free.size()));
    how.rounds = thorough ? 2 : 1;
    Fit fit = fit_parameters(campaign_, start, free, rows_, how);
    trial.fitted = finish(std::move(fit), std::move(free));
    for (const Parameter& p : candidate.parameters) trial.values.push_back(p.get(trial.fitted.model));
    const Difference c = difference_of(base.score, trial.fitted.score, campaign_.blocks.size());
    trial.gain = -c.mean;
    trial.gain_interval = {-c.interval.high, -c.interval.low};
    return trial;
  }

  /// Fits what was chosen once more, longer: it is what the user gets.
  void polish(Trial& trial) {
    what_ = "fitting " + trial.effect + " to the end";
    std::vector<Parameter> free = trial.fitted.free;
    FitOptions how = fitting(8 * static_cast<int>(free.size()));
    how.trials = how.trials * 3 / 2;
    how.rounds = 2;
    Fitted longer = finish(fit_parameters(campaign_, trial.fitted.model, free, rows_, how), free);
    if (!(longer.score.total < trial.fitted.score.total)) return;
    trial.fitted = std::move(longer);
    for (std::size_t i = 0; i < trial.parameters.size(); ++i)
      trial.values[i] = trial.parameters[i].get(trial.fitted.model);
  }

  /// By how much a candidate lowers the error of blocks that its fit has not seen.
  double cross_validate(const Fitted& base, const Trial& trial) const {
    double gain = 0.0;
    for (int fold = 0; fold < kFolds; ++fold) {
      std::vector<bool> in = rows_, out(rows_.size(), false);
      int number = 0;
      for (std::size_t b = 0; b < rows_.size(); ++b) {
        if (!rows_[b] || number++ % kFolds != fold) continue;
        in[b] = false;
        out[b] = true;
      }
      // From the fit to all rows: only what the fold changes has to be found.
      const int evaluations = 2 * static_cast<int>(trial.fitted.free.size());
      const Fit with_it = fit_parameters(campaign_, trial.fitted.model, trial.fitted.free, in, fitting(evaluations));
      const Fit without = fit_parameters(campaign_, base.model, base.free, in, fitting(evaluations));
      if (with_it.interrupted || without.interrupted) throw DiagnosisInterrupted{};
      ObserveOptions how = observing(options_.final_trials);
      how.blocks = out;
      const Score a = score(campaign_, observe(campaign_, without.model, how), out);
      const Score b = score(campaign_, observe(campaign_, with_it.model, how), out);
      gain += (a.total - b.total) / kFolds;
    }
    return gain;
  }

  Round turn(const Fitted& base, const std::vector<std::string>& found, double level, bool more) {
    Round round;
    round.residual = residual_of(base);
    progress_ += 0.1, what_ = "testing the candidates";
    say(progress_, what_);
    const std::vector<Candidate> candidates = candidates_of(campaign_, base.model, base.fitting, found);
    const Axis axis = axis_of(campaign_, base.fitting);
    ScoreTestOptions how;
    how.trials = options_.test_trials;
    how.seed = options_.seed;
    how.threads = options_.threads;
    const ScoreTest test = score_test(campaign_, base.model, base.free, base.z, base.fitting, candidates, rows_, how);
    round.p_value = test.p_value;
    const bool noise = test.p_value > level;
    if (!more || (noise && !found.empty())) {  // nothing left, or as much as may be added
      round.effect = noise ? what_is_left(round) : "unexplained";
      return round;
    }
    for (const EffectVerdict& verdict : test.effects) {
      what_ = "fitting " + verdict.effect;
      progress_ = std::min(0.95, progress_ + 0.02);
      const bool thorough = round.trials.size() < kThorough && verdict.p_value < level;
      round.trials.push_back(try_effect(base, verdict, resolved(candidates, verdict.best, axis), thorough));
    }
    choose(base, round, noise, level);
    return round;
  }

  static std::string what_is_left(const Round& round) {
    return !round.residual.empty() && round.residual.front().corrected < 0.01 ? "unexplained" : "none";
  }

  /// How often each trial has the lowest error, drawing blocks with replacement.
  void count_choices(const Fitted& base, std::vector<Trial>& trials) const {
    std::vector<Difference> all;
    for (const Trial& t : trials) all.push_back(difference_of(base.score, t.fitted.score, campaign_.blocks.size()));
    if (all.empty()) return;
    const std::size_t draws = all.front().draws.size();
    for (std::size_t draw = 0; draw < draws; ++draw) {
      const auto best = std::min_element(all.begin(), all.end(), [draw](const Difference& a, const Difference& b) {
        return a.draws[draw] < b.draws[draw];
      });
      trials[static_cast<std::size_t>(best - all.begin())].chosen_share += 1.0 / static_cast<double>(draws);
    }
  }

  void choose(const Fitted& base, Round& round, bool noise, double level) {
    count_choices(base, round.trials);
    const auto may = [level](const Trial& t) { return t.p_value < level && t.gain > 0.0; };
    std::stable_sort(round.trials.begin(), round.trials.end(),
                     [&](const Trial& a, const Trial& b) { return may(a) != may(b) ? may(a) : a.gain > b.gain; });
    if (noise || round.trials.empty() || !may(round.trials.front())) {
      round.effect = noise ? what_is_left(round) : "unexplained";
      return;
    }
    Trial& best = round.trials.front();
    what_ = "cross-validating " + best.effect;
    best.cross_validated = cross_validate(base, best);
    if (!(best.cross_validated > 0.0)) {
      round.effect = "unexplained";
      return;
    }
    round.effect = best.effect;
    round.where = best.where;
    for (std::size_t i = 1; i < round.trials.size(); ++i) {
      const Trial& other = round.trials[i];
      if (!may(other)) continue;
      const Difference c = difference_of(other.fitted.score, best.fitted.score, campaign_.blocks.size());
      if (c.interval.high > 0.0) round.alike.push_back(other.effect);
    }
  }

  const Campaign& campaign_;
  const DiagnoseOptions& options_;
  std::vector<bool> rows_;
  double progress_ = 0.0;
  std::string what_;
};

}  // namespace

Difference difference_of(const Score& before, const Score& after, std::size_t blocks, std::uint32_t draws) {
  Difference c;
  c.mean = after.total - before.total;
  for (std::uint32_t draw = 0; draw < draws; ++draw) {
    const std::vector<double> weights = bootstrap_weights(before, blocks, draw, 1);
    c.draws.push_back(weighted_total(after, weights) - weighted_total(before, weights));
  }
  std::vector<double> sorted = c.draws;
  std::sort(sorted.begin(), sorted.end());
  c.interval = {quantile(sorted, 0.025), quantile(sorted, 0.975)};
  return c;
}

Diagnosis diagnose(const Campaign& campaign, const Model& start, const DiagnoseOptions& options) {
  return Diagnosing(campaign, options).run(start);
}

}  // namespace talus
