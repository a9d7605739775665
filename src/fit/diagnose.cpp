#include "talus/fit/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/random.hpp"

namespace talus {
namespace {

constexpr std::size_t kFolds = 2;
constexpr std::size_t kThorough = 3;   // of the effects that the test finds most significant
constexpr std::size_t kLaterFits = 6;  // after the first round: with an effect in place all takes several times as long
constexpr double kWorthASearch = 0.1;  // p of the score test
constexpr std::uint32_t kManyBlocks = 72;  // of fewer, more trials each are tested: a signature is a mean over blocks
constexpr double kPrice = 0.56;            // by which one more fitted number must lower the error, times fitting blocks

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
  std::uint32_t asked() const { return static_cast<std::uint32_t>(std::count(rows_.begin(), rows_.end(), true)); }

  bool proceeds() const { return !options_.proceed || options_.proceed(progress_); }

  ObserveOptions observing(std::uint32_t trials) const {
    return {trials, options_.seed, kUnseen, options_.threads, rows_, {}};
  }

  /// As `calibrate` does it.
  FitOptions fitting() const {
    FitOptions how;
    how.trials = options_.search_trials;
    how.seed = options_.seed;
    how.threads = options_.threads;
    how.proceed = [this](double) { return proceeds(); };
    return how;
  }

  /// From a start that is near, with so many evaluations.
  FitOptions short_fit(int evaluations, int rounds) const {
    FitOptions how = fitting();
    how.polish_trials = 2 * options_.search_trials;
    how.starts = 1;
    how.evaluations = evaluations;
    how.rounds = rounds;
    return how;
  }

  /// On luck that the search has not seen.
  Fitted finish(Fit&& fit, std::vector<Parameter> free) const {
    if (fit.interrupted) throw FitInterrupted{};
    Fitted out{std::move(fit.model), std::move(free), std::move(fit.z), {}, {}};
    out.fitting = observe(campaign_, out.model, observing(options_.final_trials));
    out.score = score(campaign_, out.fitting, rows_);
    return out;
  }

  Fitted fit_base(const Model& start) {
    const std::vector<BlockRuns> runs = observe(campaign_, start, observing(options_.search_trials));
    std::vector<Parameter> free = ground_parameters(campaign_, start, options_.keys, touched_zones(campaign_, runs));
    Fit fit = fit_parameters(campaign_, start, free, rows_, fitting());
    return finish(std::move(fit), std::move(free));
  }

  std::vector<ResidualRow> residual_of(const Fitted& fitted) const {
    return residual_table(campaign_, ResidualSpace(campaign_, fitted.fitting), rows_);
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

  /// The best of some places to start a search from: the effect in several amounts, each with the ground as it is and
  /// moved as the score test expects it to. An amount of zero, the base itself, is one of them.
  Eigen::VectorXd scan(const FitProblem& problem, const FitOptions& how, const Fitted& base, const Candidate& candidate,
                       const Verdict& verdict) const {
    const Eigen::VectorXd effect = start_of(candidate, verdict);
    const Eigen::Index ground = std::ssize(problem.free) - effect.size();
    const double share = std::clamp(effect[0] / std::max(1e-9, kNoticed * std::abs(verdict.estimate[0])), 0.0, 1.0);
    Evaluation best;
    best.objective = std::numeric_limits<double>::infinity();
    for (const double amount : {0.0, 0.5, 1.0, 2.0, 4.0})
      for (const bool along : {false, true}) {
        if (along && (ground == 0 || amount == 0.0)) continue;
        Eigen::VectorXd z(std::ssize(problem.free));
        if (ground > 0) z.head(ground) = base.z;
        if (along) z.head(ground) += (amount * share * verdict.ground).cwiseMax(-1.5).cwiseMin(1.5);
        z.tail(effect.size()) = amount * effect;
        Evaluation here = evaluate(problem, how, z, {how.trials});
        if (here.objective < best.objective) best = std::move(here);
      }
    return best.z;
  }

  /// What a candidate of so many fitted numbers gains by chance alone; docs/closing-the-loop.md, "Choice".
  double price_of(double numbers) const { return kPrice * numbers / asked(); }

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
    const FitOptions how = short_fit((thorough ? 6 : 3) * static_cast<int>(free.size()), thorough ? 3 : 1);
    const Model off = with(base.model, candidate, Eigen::VectorXd::Zero(std::ssize(candidate.parameters)));
    const Eigen::VectorXd z = scan({campaign_, off, free, rows_}, how, base, candidate, verdict.best);
    Fit fit = fit_parameters(campaign_, model_at(off, free, z), free, rows_, how);
    trial.fitted = finish(std::move(fit), std::move(free));
    for (const Parameter& p : candidate.parameters) trial.values.push_back(p.get(trial.fitted.model));
    const Difference c = difference(base.score, trial.fitted.score, campaign_.blocks.size());
    trial.gain = -c.mean;
    trial.price = price_of(static_cast<double>(candidate.parameters.size()) + candidate.searched);
    trial.gain_interval = {-c.interval.high, -c.interval.low};
    return trial;
  }

  /// Fits what was chosen once more, as `calibrate` does: it is what the user gets.
  void polish(Trial& trial) const {
    const std::vector<Parameter> free = trial.fitted.free;
    FitOptions how = fitting();
    how.starts = 1;
    Fitted longer = finish(fit_parameters(campaign_, trial.fitted.model, free, rows_, how), free);
    if (!(longer.score.total < trial.fitted.score.total)) return;
    trial.fitted = std::move(longer);
    for (std::size_t i = 0; i < trial.parameters.size(); ++i)
      trial.values[i] = trial.parameters[i].get(trial.fitted.model);
  }

  /// The fitting rows in a random order: neighbours in the file are often of one day or one kind.
  std::vector<std::size_t> shuffled_rows() const {
    std::vector<std::pair<std::uint32_t, std::size_t>> keyed;
    for (std::size_t b = 0; b < rows_.size(); ++b)
      if (rows_[b])
        keyed.emplace_back(
            Random(options_.seed, static_cast<std::uint32_t>(b), kUnseen, Purpose::Bootstrap).words(0)[0], b);
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::size_t> order;
    for (const auto& [key, block] : keyed) order.push_back(block);
    return order;
  }

  /// By how much a candidate lowers the error of blocks that its fit has not seen.
  double cross_validate(const Fitted& base, const Trial& trial) const {
    double gain = 0.0;
    const std::vector<std::size_t> order = shuffled_rows();
    for (std::size_t fold = 0; fold < kFolds; ++fold) {
      std::vector<bool> in = rows_, out(rows_.size(), false);
      for (std::size_t i = fold; i < order.size(); i += kFolds) {
        in[order[i]] = false;
        out[order[i]] = true;
      }
      // From the fit to all rows: only what the fold changes has to be found.
      const int evaluations = 2 * static_cast<int>(trial.fitted.free.size());
      const Fit with_it =
          fit_parameters(campaign_, trial.fitted.model, trial.fitted.free, in, short_fit(evaluations, 1));
      const Fit without = fit_parameters(campaign_, base.model, base.free, in, short_fit(evaluations, 1));
      if (with_it.interrupted || without.interrupted) throw FitInterrupted{};
      ObserveOptions how = observing(options_.final_trials);
      how.blocks = out;
      const Score a = score(campaign_, observe(campaign_, without.model, how), out);
      const Score b = score(campaign_, observe(campaign_, with_it.model, how), out);
      gain += (a.total - b.total) / static_cast<double>(kFolds);
    }
    return gain;
  }

  Round turn(const Fitted& base, const std::vector<std::string>& found, double level, bool more) {
    Round round;
    round.residual = residual_of(base);
    progress_ += 0.1;
    const std::vector<Candidate> candidates = candidates_of(campaign_, base.model, base.fitting, found);
    const Axis axis = axis_of(campaign_, base.fitting);
    ScoreTestOptions how;
    how.trials = std::max(options_.test_trials, options_.test_trials * kManyBlocks / asked());
    how.seed = options_.seed;
    how.threads = options_.threads;
    how.proceed = [this] { return proceeds(); };
    const ScoreTest test = score_test(campaign_, {base.model, base.free, base.z, base.fitting}, candidates, rows_, how);
    round.p_value = test.p_value;
    const bool noise = test.p_value > level;
    if (!more || (noise && !found.empty())) {  // nothing left, or as much as may be added
      round.effect = noise ? what_is_left(round) : "unexplained";
      return round;
    }
    round.trials.reserve(test.effects.size());
    for (const EffectVerdict& verdict : test.effects) {
      // All have been fitted in the first round; from then on those that may be chosen, the most significant first.
      if (!found.empty() && (verdict.p_value >= level || round.trials.size() == kLaterFits)) continue;
      progress_ = std::min(0.95, progress_ + 0.02);
      const bool thorough = round.trials.size() < kThorough && verdict.p_value < level;
      round.trials.push_back(
          try_effect(base, verdict, together(campaign_, axis, candidates, verdict.best.members), thorough));
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
    all.reserve(trials.size());
    for (const Trial& t : trials) {
      all.push_back(difference(base.score, t.fitted.score, campaign_.blocks.size()));
      for (double& draw : all.back().draws) draw += t.price;
    }
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
    const auto net = [](const Trial& t) { return t.gain - t.price; };
    const auto may = [&](const Trial& t) { return t.p_value < level && net(t) > 0.0; };
    std::stable_sort(round.trials.begin(), round.trials.end(),
                     [&](const Trial& a, const Trial& b) { return may(a) != may(b) ? may(a) : net(a) > net(b); });
    if (noise || round.trials.empty() || !may(round.trials.front())) {
      round.effect = noise ? what_is_left(round) : "unexplained";
      return;
    }
    Trial& best = round.trials.front();
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
      const Difference c = difference(other.fitted.score, best.fitted.score, campaign_.blocks.size());
      if (c.interval.high > 0.0) round.alike.push_back(other.effect);
    }
  }

  const Campaign& campaign_;
  const DiagnoseOptions& options_;
  std::vector<bool> rows_;
  double progress_ = 0.0;
};

}  // namespace

Diagnosis diagnose(const Campaign& campaign, const Model& start, const DiagnoseOptions& options) {
  return Diagnosing(campaign, options).run(start);
}

}  // namespace talus
