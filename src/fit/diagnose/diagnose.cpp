#include "talus/fit/diagnose/diagnose.hpp"

#include <algorithm>
#include <cmath>

#include "effect_fits.hpp"
#include "talus/fit/diagnose/undeclared_places.hpp"

namespace talus {
namespace {

constexpr std::size_t kContenders = 4;       // whose fits go on: those that gain most
constexpr std::size_t kLaterContenders = 2;  // after the first round all takes several times as long,
constexpr std::size_t kLaterFits = 6;        // with an effect in place
constexpr double kWorthNaming = 0.02;        // share of the objective that an effect takes away
constexpr double kWorthUnseen = 0.01;        // the same of blocks that its fit has not seen
constexpr double kNothing = 0.1;             // of what one would notice: so little of an effect explains nothing
constexpr double kHalfWay = 0.5;             // of kWorthNaming: a gain from which on the fit may yet get there
constexpr double kUnfinished = 0.02;         // [objective] that a first fit may still be above its minimum
constexpr double kManyBlocks = 72.0;         // of fewer, more trials each
constexpr double kGroundShare = 0.3, kTestShare = 0.05;  // of the time of a diagnosis, roughly
constexpr double kMostOfOne = 4.0;                       // times as many, so that five blocks do not ask for thousands

double net(const Trial& trial) {
  return trial.gain - trial.price;
}

/// The work of one diagnosis.
class Diagnosing {
 public:
  Diagnosing(const Campaign& campaign, const DiagnoseOptions& options)
      : campaign_(campaign),
        rows_(fitting_rows(campaign)),
        options_(options),
        fits_(campaign, options_, rows_, [this](double share) { return proceeds(share); }) {
    const auto fitting = std::count(rows_.begin(), rows_.end(), true);
    options_.trials = shared_out(options.trials, static_cast<std::size_t>(fitting));
  }

  Diagnosis run(const Model& start) {
    Diagnosis d;
    d.with_effects = fits_.ground(start);
    advance(kGroundShare);
    std::vector<std::string> found;
    for (int round = 0; round <= options_.most_effects; ++round) {
      const double level = round == 0 ? options_.first_level : options_.later_level;
      d.with_effects = fits_.begin_round(std::move(d.with_effects));
      if (round == 0) d.base = d.with_effects;
      d.rounds.push_back(turn(d.with_effects, found, level, round < options_.most_effects));
      const Round& last = d.rounds.back();
      if (last.effect == "none" || last.effect == "unexplained") break;
      found.push_back(last.effect);
      d.with_effects = d.rounds.back().trials.front().fitted;
    }
    if (!found.empty()) d.base = fits_.again(std::move(d.base));
    d.trials = options_.trials;
    return d;
  }

 private:
  void advance(double share = 0.02) { progress_ = std::min(0.95, progress_ + share); }
  /// @param share  of a fit; only that of the ground, the longest, is shown
  bool proceeds(double share = 1.0) {
    if (progress_ == 0.0) ground_ = std::max(ground_, kGroundShare * share);
    return !options_.proceed || options_.proceed(std::max(progress_, ground_));
  }

  std::vector<ResidualRow> residual_of(const Fitted& fitted) const {
    return residual_table(campaign_, ResidualSpace(campaign_, fitted.fitting), rows_);
  }

  /// @param base  what has been found so far
  Round turn(const Fitted& base, const std::vector<std::string>& found, double level, bool more) {
    Round round;
    round.residual = residual_of(base);
    advance(kTestShare);
    const std::vector<Candidate> candidates = candidates_of(campaign_, base.model, base.fitting, found);
    const Axis axis = axis_of(campaign_, base.fitting);
    ScoreTestOptions how;
    how.trials = options_.trials.test;
    how.seed = options_.seed;
    how.threads = options_.threads;
    how.proceed = [this] { return proceeds(); };
    const ScoreTest test = score_test(campaign_, {base.model, base.free, base.z, base.fitting}, candidates, rows_, how);
    round.p_value = test.p_value;
    const bool noise = test.p_value > level;
    if (!more || (noise && !found.empty())) {  // nothing left, or as much as may be added
      round.effect = what_is_left(round);
      return round;
    }
    round.trials.reserve(test.effects.size());
    for (const EffectVerdict& verdict : test.effects) {
      // All have been fitted in the first round; from then on those that may be chosen, the most significant first.
      if (!found.empty() && (verdict.p_value >= level || round.trials.size() == kLaterFits)) continue;
      advance();
      const EffectVerdict placed = in_better_zone(base, verdict, candidates);
      round.trials.push_back(fits_.effect(base, placed, together(campaign_, axis, candidates, placed.best.members)));
    }
    if (!noise) compete(base, round.trials, level, found.empty() ? kContenders : kLaterContenders);
    choose(base, round, noise);
    return round;
  }

  /// The test, which is linear, may find a strong effect in the wrong zone: where the second best one is significant,
  /// too, a look at both decides.
  EffectVerdict in_better_zone(const Fitted& base, const EffectVerdict& verdict,
                               const std::vector<Candidate>& candidates) const {
    EffectVerdict placed = verdict;
    if (verdict.second.members.empty() || verdict.second.p_value > options_.later_level) return placed;
    const Candidate& first = candidates[verdict.best.members.front()];
    const Candidate& second = candidates[verdict.second.members.front()];
    const bool in_zone = first.where == "everywhere" || first.where.starts_with("zone ");
    if (in_zone && fits_.promise(base, verdict.second, second) < fits_.promise(base, verdict.best, first))
      placed.best = verdict.second;
    return placed;
  }

  /// The fits of those go on that may be chosen and gain most, or could yet; of those that may still win, with more
  /// trials. In the first round the base's has had as many before.
  void compete(const Fitted& base, std::vector<Trial>& trials, double level, std::size_t most) {
    std::vector<Trial*> contenders;
    for (Trial& t : trials)
      if (t.p_value < level) contenders.push_back(&t);
    drop_losers(contenders, most, -kUnfinished);
    for (Trial* t : contenders) {
      advance();
      fits_.go_on(base, *t);
    }
    drop_losers(contenders, most, kHalfWay * kWorthNaming * base.objective.total);
    for (Trial* t : contenders) {
      advance();
      fits_.polish(base, *t);
    }
    if (contenders.empty()) return;
    const double before = fits_.cross_validated(base);
    for (Trial* t : contenders) t->cross_validated = before - fits_.cross_validated(t->fitted);
  }

  /// Leaves the few that gain most: those that gain so much at least and may yet win.
  void drop_losers(std::vector<Trial*>& contenders, std::size_t most, double least) const {
    if (contenders.empty()) return;
    std::stable_sort(contenders.begin(), contenders.end(),
                     [](const Trial* a, const Trial* b) { return net(*a) > net(*b); });
    contenders.resize(std::min(contenders.size(), most));
    const Score& best = contenders.front()->fitted.objective;
    const auto behind = [&](const Score& own) { return difference(best, own, campaign_.blocks.size()).interval.low; };
    std::erase_if(contenders,
                  [&](const Trial* t) { return t->gain < least || behind(t->fitted.objective) > kUnfinished; });
  }

  /// Nothing explains the residual. It is there if the score test, or a row of the table, says so at the stricter
  /// level.
  std::string what_is_left(const Round& round) const {
    const bool in_table = !round.residual.empty() && round.residual.front().corrected < options_.later_level;
    return in_table || round.p_value <= options_.later_level ? "unexplained" : "none";
  }

  /// How often each trial has the lowest error, drawing blocks with replacement.
  void count_choices(const Fitted& base, std::vector<Trial>& trials) const {
    std::vector<Difference> all;
    all.reserve(trials.size());
    for (const Trial& t : trials) {
      all.push_back(difference(base.objective, t.fitted.objective, campaign_.blocks.size()));
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

  void choose(const Fitted& base, Round& round, bool noise) const {
    count_choices(base, round.trials);
    const Worth worth{kWorthNaming * base.objective.total, kWorthUnseen * base.objective.total};
    const auto may = [&](const Trial& t) {
      return t.amount > kNothing && t.gain > worth.fitted && t.unseen_gain() > worth.unseen;
    };
    std::stable_sort(round.trials.begin(), round.trials.end(), [&](const Trial& a, const Trial& b) {
      if (may(a) != may(b)) return may(a);
      return may(a) ? a.unseen_gain() > b.unseen_gain() : net(a) > net(b);
    });
    const auto chosen = std::find_if(round.trials.begin(), round.trials.end(), [&](const Trial& t) {
      return !noise && may(t) && fits_.confirmed(base, t, worth);
    });
    if (chosen == round.trials.end()) {
      round.effect = what_is_left(round);
      return;
    }
    std::rotate(round.trials.begin(), chosen, chosen + 1);
    const Trial& best = round.trials.front();
    round.effect = best.effect;
    round.where = best.where;
    for (std::size_t i = 1; i < round.trials.size(); ++i) {
      const Trial& other = round.trials[i];
      if (!may(other)) continue;
      const Difference c = difference(other.fitted.objective, best.fitted.objective, campaign_.blocks.size());
      if (c.interval.high > 0.0) round.alike.push_back(other.effect);
    }
  }

  const Campaign& campaign_;
  std::vector<bool> rows_;
  DiagnoseOptions options_;
  EffectFits fits_;
  double progress_ = 0.0, ground_ = 0.0;
};

}  // namespace

TrialsPerBlock shared_out(TrialsPerBlock trials, std::size_t blocks) {
  const double more = std::clamp(kManyBlocks / static_cast<double>(blocks), 1.0, kMostOfOne);
  for (std::uint32_t* count : {&trials.search, &trials.test, &trials.compare})
    *count = static_cast<std::uint32_t>(std::lround(more * *count));
  return trials;
}

Diagnosis diagnose(const Campaign& campaign, const Model& start, const DiagnoseOptions& options) {
  return Diagnosing(campaign, options).run(start);
}

}  // namespace talus
