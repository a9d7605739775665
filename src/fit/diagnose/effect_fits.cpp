#include "effect_fits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/calibrate/local_model.hpp"
#include "talus/base/random.hpp"

namespace talus {
namespace {

constexpr double kNoticed = DiagnosisRules{}.noticed;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kFolds = 5;
constexpr std::uint32_t kOrders = 5;      // in which the blocks are cut into folds: one may be unlucky
constexpr double kWorthASearch = 0.1;     // p of the score test
constexpr double kPrice = 0.56;           // by which one more fitted number must lower the error, times fitting blocks
constexpr std::uint32_t kConfirming = 4;  // times as many trials as the scores
constexpr double kWorthARound = 0.002;    // of the objective, by one round of the quadratic model
/// Trials of a round, in units of those that compare fits: for the choice and its cross-validation, then the same to
/// confirm it.
constexpr std::uint32_t kTrialsOfRound = 1 + kOrders + kOrders + kConfirming;

/// Where the search of a candidate starts: the estimate of the score test, kept within reason.
VectorXd start_of(const Candidate& candidate, const Verdict& verdict) {
  VectorXd z = VectorXd::Zero(static_cast<Index>(candidate.parameters.size()));
  for (Index i = 0; i < verdict.estimate.size(); ++i) {
    const Parameter& p = candidate.parameters[static_cast<std::size_t>(i)];
    const double low = p.lower >= 0.0 ? 0.3 : -2.0;
    z[i] = kNoticed * std::clamp(verdict.estimate[i], low, 4.0);
  }
  return z;
}

/// As wide in the ground's parameters as its own fit left it; in those of the effect from none of it to twice as much.
MatrixXd first_spread(const MatrixXd& ground, const VectorXd& effect) {
  const Index n = ground.rows() + effect.size();
  MatrixXd spread = MatrixXd::Zero(n, n);
  spread.topLeftCorner(ground.rows(), ground.rows()) = ground;
  spread.diagonal().tail(effect.size()) = (0.5 * effect).cwiseAbs().cwiseMax(0.5 * kNoticed).cwiseAbs2();
  return spread;
}

/// What was tried without an effect was tried with nothing of it.
std::vector<Evaluation> without_effect(const std::vector<Evaluation>& tried, Index effect) {
  std::vector<Evaluation> padded = tried;
  for (Evaluation& e : padded) {
    e.z.conservativeResize(e.z.size() + effect);
    e.z.tail(effect).setZero();
  }
  return padded;
}

}  // namespace

ObserveOptions EffectFits::observing(std::uint32_t trials) const {
  const std::uint32_t first = kUnseen + round_ * kTrialsOfRound * options_.trials.compare;
  return {trials, options_.seed, first, options_.threads, rows_, {}};
}

FitOptions EffectFits::fitting() const {
  FitOptions how;
  how.trials = options_.trials.search;
  how.comparison_trials = 4 * options_.trials.search;
  how.seed = options_.seed;
  how.threads = options_.threads;
  how.proceed = proceed_;
  return how;
}

Fitted EffectFits::better(Fitted fitted, Fitted longer) {
  if (longer.objective.total < fitted.objective.total) return longer;
  fitted.tried = std::move(longer.tried);
  return fitted;
}

Fitted EffectFits::again(Fitted fitted) const {
  fitted.fitting = observe(campaign_, fitted.model, observing(options_.trials.compare));
  fitted.score = score(campaign_, fitted.fitting, rows_);
  fitted.objective = weigh_groups(fitted.score);
  return fitted;
}

Fitted EffectFits::begin_round(Fitted base) {
  ++round_;
  return again(std::move(base));
}

/// Scored on luck that the search has not seen.
Fitted EffectFits::finish(Fit&& fit, std::vector<Parameter> free) const {
  if (fit.interrupted) throw FitInterrupted{};
  Fitted out;
  out.model = std::move(fit.model);
  out.free = std::move(free);
  out.z = std::move(fit.z);
  out.spread = std::move(fit.spread);
  out.tried = std::move(fit.evaluations);
  return again(std::move(out));
}

Fitted EffectFits::ground(const Model& start) const {
  const std::vector<BlockRuns> runs = observe(campaign_, start, observing(options_.trials.search));
  std::vector<Parameter> free = ground_parameters(campaign_, start, options_.keys, touched_zones(campaign_, runs));
  FitOptions how = fitting();  // all that follows rests on this fit
  how.trials *= 2;
  how.comparison_trials *= 2;
  Fit fit = fit_parameters(campaign_, start, free, rows_, how);
  Fitted fitted = finish(std::move(fit), std::move(free));
  FitOptions on = going_on(fitted);
  on.trials = how.trials;
  on.comparison_trials = how.comparison_trials;
  Fitted longer = refined(fitted, on);
  return better(std::move(fitted), std::move(longer));
}

/// A model without any of the effect, to which amounts of it may be added.
Model EffectFits::without(const Fitted& base, const Candidate& candidate) {
  return with(base.model, candidate, VectorXd::Zero(std::ssize(candidate.parameters)));
}

double EffectFits::promise(const Fitted& base, const Verdict& verdict, const Candidate& candidate) const {
  std::vector<Parameter> free = base.free;
  free.insert(free.end(), candidate.parameters.begin(), candidate.parameters.end());
  const Model off = without(base, candidate);
  return scan({campaign_, off, free, rows_}, fitting(), base, candidate, verdict).objective;
}

/// The best of some places to start from: the effect in several amounts, each with the ground as it is and moved as the
/// score test expects it to. An amount of zero, the base itself, is one of them.
Evaluation EffectFits::scan(const FitProblem& problem, const FitOptions& how, const Fitted& base,
                            const Candidate& candidate, const Verdict& verdict) const {
  const VectorXd effect = start_of(candidate, verdict);
  const Index ground = std::ssize(problem.free) - effect.size();
  const double share = std::clamp(effect[0] / std::max(1e-9, kNoticed * std::abs(verdict.estimate[0])), 0.0, 1.0);
  Evaluation best;
  best.objective = std::numeric_limits<double>::infinity();
  for (const double amount : {0.0, 0.5, 1.0, 2.0, 4.0})
    for (const bool along : {false, true}) {
      if (along && (ground == 0 || amount == 0.0)) continue;
      VectorXd z(std::ssize(problem.free));
      if (ground > 0) z.head(ground) = base.z;
      if (along) z.head(ground) += (amount * share * verdict.ground).cwiseMax(-1.5).cwiseMin(1.5);
      z.tail(effect.size()) = amount * effect;
      Evaluation here = evaluate(problem, how, z, {how.trials});
      if (here.objective < best.objective) best = std::move(here);
    }
  return best;
}

void EffectFits::adopt(Fitted&& fitted, Trial& trial) {
  trial.fitted = std::move(fitted);
  trial.values.clear();
  for (const Parameter& p : trial.parameters) trial.values.push_back(p.get(trial.fitted.model));
  const auto own = std::ssize(trial.parameters);
  trial.amount = trial.fitted.z.tail(own).head(static_cast<Index>(trial.tested)).cwiseAbs().maxCoeff() / kNoticed;
}

void EffectFits::compare(const Fitted& base, Trial& trial) const {
  const Difference c = difference(base.objective, trial.fitted.objective, campaign_.blocks.size());
  trial.gain = -c.mean;
  trial.gain_interval = {-c.interval.high, -c.interval.low};
}

Trial EffectFits::effect(const Fitted& base, const EffectVerdict& verdict, const Candidate& candidate) const {
  Trial trial;
  trial.effect = candidate.effect;
  trial.where = candidate.where;
  trial.p_value = verdict.p_value;
  trial.statistic = verdict.best.statistic;
  trial.parameters = candidate.parameters;
  trial.tested = candidate.tested;
  const auto asked = static_cast<double>(std::count(rows_.begin(), rows_.end(), true));
  trial.price = kPrice * (static_cast<double>(candidate.parameters.size()) + candidate.searched) / asked;
  trial.place_price = kPrice * candidate.searched / asked;
  trial.joint = verdict.p_value < std::max(kWorthASearch, options_.first_level);  // what may be chosen is
  std::vector<Parameter> free = trial.joint ? base.free : std::vector<Parameter>{};
  free.insert(free.end(), candidate.parameters.begin(), candidate.parameters.end());
  const Index added = std::ssize(candidate.parameters);
  FitOptions how = fitting();
  how.starts = 0;
  how.rounds = 2;
  how.enough = kWorthARound;
  how.design = trial.joint ? 4 * static_cast<int>(free.size()) : 20;
  const Model off = without(base, candidate);
  const VectorXd z = scan({campaign_, off, free, rows_}, how, base, candidate, verdict.best).z;
  std::vector<Evaluation> known;
  if (trial.joint) known = without_effect(base.tried, added);
  how.known = known;
  how.spread = first_spread(trial.joint ? base.spread : MatrixXd(0, 0), z.tail(added));
  Fit fit = fit_parameters(campaign_, model_at(off, free, z), free, rows_, how);
  adopt(finish(std::move(fit), std::move(free)), trial);
  compare(base, trial);
  return trial;
}

/// From where a fit ended, with what it has tried.
Fitted EffectFits::refined(const Fitted& fitted, FitOptions how) const {
  how.starts = 0;
  how.spread = fitted.spread;
  how.known = fitted.tried;
  return finish(fit_parameters(campaign_, fitted.model, fitted.free, rows_, how), fitted.free);
}

FitOptions EffectFits::going_on(const Fitted& fitted) const {
  FitOptions how = fitting();
  how.rounds = 3;
  how.enough = kWorthARound;
  how.design = 6 * static_cast<int>(fitted.free.size());
  return how;
}

void EffectFits::go_on(const Fitted& base, Trial& trial) const {
  continued(base, trial, going_on(trial.fitted));
}

void EffectFits::polish(const Fitted& base, Trial& trial) const {
  FitOptions how = fitting();
  how.trials *= 2;
  how.comparison_trials *= 2;
  how.rounds = 2;
  continued(base, trial, how);
}

void EffectFits::continued(const Fitted& base, Trial& trial, const FitOptions& how) const {
  Fitted longer = refined(trial.fitted, how);
  adopt(better(std::move(trial.fitted), std::move(longer)), trial);
  compare(base, trial);
}

/// The fitting rows in a random order: neighbours in the file are often of one day or one kind.
std::vector<std::size_t> EffectFits::shuffled_rows(std::uint32_t number) const {
  std::vector<std::pair<std::uint32_t, std::size_t>> keyed;
  for (std::size_t b = 0; b < rows_.size(); ++b) {
    const Random random(options_.seed, static_cast<std::uint32_t>(b), kUnseen, Purpose::Bootstrap);
    if (rows_[b]) keyed.emplace_back(random.words(number)[0], b);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::size_t> order;
  for (const auto& [key, block] : keyed) order.push_back(block);
  return order;
}

double EffectFits::cross_validated(const Fitted& fitted, ObserveOptions how) const {
  const FitProblem problem{campaign_, fitted.model, fitted.free, rows_};
  const FitOptions options = fitting();
  Fit fit;
  fit.z = fitted.z;
  fit.score = fitted.objective;
  fit.evaluations = fitted.tried;
  const LocalModel local(problem, options, fit, fitted.spread);
  double sum = 0.0;
  for (std::uint32_t number = 0; number < kOrders; ++number, how.first_trial += how.trials)  // luck of its own
    sum += error_in_folds(local, fitted, how, shuffled_rows(number));
  return sum / kOrders;
}

double EffectFits::error_in_folds(const LocalModel& local, const Fitted& fitted, ObserveOptions how,
                                  const std::vector<std::size_t>& order) const {
  std::vector<BlockRuns> runs(campaign_.blocks.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    if (!proceed_(1.0)) throw FitInterrupted{};
    std::vector<double> others(runs.size(), 1.0);
    how.blocks.assign(runs.size(), false);
    for (std::size_t i = fold; i < order.size(); i += kFolds) {
      others[order[i]] = 0.0;
      how.blocks[order[i]] = true;
    }
    const Model model = model_at(fitted.model, fitted.free, local.optimum(others, fitted.spread));
    std::vector<BlockRuns> seen = observe(campaign_, model, how);
    for (std::size_t i = fold; i < order.size(); i += kFolds) runs[order[i]] = std::move(seen[order[i]]);
  }
  return weigh_groups(score(campaign_, runs, rows_)).total;
}

bool EffectFits::confirmed(const Fitted& base, const Trial& trial, const Worth& worth) const {
  ObserveOptions unseen = observing(options_.trials.compare);
  unseen.first_trial += (1 + kOrders) * options_.trials.compare;  // after those of the choice and its cross-validation
  if (cross_validated(base, unseen) - cross_validated(trial.fitted, unseen) - trial.place_price < worth.unseen)
    return false;
  unseen.first_trial += kOrders * options_.trials.compare;
  unseen.trials *= kConfirming;
  const auto error = [&](const Fitted& fitted) {
    return weigh_groups(score(campaign_, observe(campaign_, fitted.model, unseen), rows_)).total;
  };
  return error(base) - error(trial.fitted) >= worth.fitted;
}

}  // namespace talus
