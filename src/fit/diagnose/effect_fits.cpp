#include "effect_fits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/fit/diagnose/candidates.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Start of the fit of a candidate: about the estimate of the score test.
VectorXd start_of(const Candidate& candidate, const Verdict& verdict, double noticed) {
  VectorXd z = VectorXd::Zero(static_cast<Index>(candidate.parameters.size()));
  for (Index i = 0; i < verdict.estimate.size(); ++i) {
    const Parameter& p = candidate.parameters[static_cast<std::size_t>(i)];
    z[i] = noticed * first_amount(p, verdict.estimate[i]);
  }
  return z;
}

/// Covariance of the first design: of the ground as its own fit left it, of the effect from none to twice its start.
MatrixXd first_spread(const MatrixXd& ground, const VectorXd& effect, double noticed) {
  const Index n = ground.rows() + effect.size();
  MatrixXd spread = MatrixXd::Zero(n, n);
  spread.topLeftCorner(ground.rows(), ground.rows()) = ground;
  spread.diagonal().tail(effect.size()) = (0.5 * effect).cwiseAbs().cwiseMax(0.5 * noticed).cwiseAbs2();
  return spread;
}

/// Evaluations made before an effect was added, as evaluations with the effect at zero.
std::vector<Evaluation> with_zero_effect(const std::vector<Evaluation>& evaluations, Index effect) {
  std::vector<Evaluation> padded = evaluations;
  for (Evaluation& e : padded) {
    e.z.conservativeResize(e.z.size() + effect);
    e.z.tail(effect).setZero();
  }
  return padded;
}

/// A model prepared for a candidate, whose parameters are still zero.
Model model_without(const FittedModel& base, const Candidate& candidate) {
  return with(base.model, candidate, VectorXd::Zero(std::ssize(candidate.parameters)));
}

std::vector<Parameter> joined(std::vector<Parameter> ground, const std::vector<Parameter>& effect) {
  ground.insert(ground.end(), effect.begin(), effect.end());
  return ground;
}

}  // namespace

ObserveOptions EffectFits::observe_options(std::uint32_t trials) const {
  return {.trials = trials,
          .seed = options_.seed,
          .first_trial = first_trial_of(options_, round_),
          .threads = options_.threads,
          .blocks = rows_,
          .effort = effort_of(options_.rules.search),
          .traced = options_.traced};
}

FitOptions EffectFits::fit_options() const {
  return search_options(options_, proceed_);
}

std::vector<BlockRuns> EffectFits::observed_in(const Campaign& campaign, const Model& model) const {
  return observe(campaign, model, observe_options(options_.trials.compare));
}

FittedModel EffectFits::simulated_anew(FittedModel fitted) const {
  fitted.runs = observed_in(campaign_, fitted.model);
  fitted.score = score(campaign_, fitted.runs, rows_);
  fitted.objective = weigh_groups(score(campaign_, fitted.runs, rows_, fit_scoring()));
  return fitted;
}

FittedModel EffectFits::begin_round(FittedModel base) {
  const Timesheet::Phase phase(times_, "comparison");
  ++round_;
  return simulated_anew(std::move(base));
}

FittedModel EffectFits::fitted_model(Fit&& fit, std::vector<Parameter> free) const {
  if (fit.interrupted) throw FitInterrupted{};
  FittedModel out;
  out.model = std::move(fit.model);
  out.free = std::move(free);
  out.z = std::move(fit.z);
  out.spread = std::move(fit.spread);
  out.evaluations = std::move(fit.evaluations);
  return simulated_anew(std::move(out));
}

FittedModel EffectFits::fit_ground(const Model& start, bool brief) const {
  const Timesheet::Phase phase(times_, "ground");
  const std::vector<BlockRuns> runs = observe(campaign_, start, observe_options(options_.trials.search));
  std::vector<Parameter> free = ground_parameters(campaign_, start, options_.keys, touched_zones(campaign_, runs));
  FitOptions how = fit_options();  // all that follows rests on this fit
  how.trials *= brief ? 1 : 2;
  how.comparison_trials *= brief ? 1 : 2;
  Fit fit = fit_parameters(campaign_, start, free, rows_, how);
  FittedModel fitted = fitted_model(std::move(fit), std::move(free));
  FitOptions on = continued_fit_options(fitted);
  on.trials = how.trials;
  on.comparison_trials = how.comparison_trials;
  FittedModel longer = continued(fitted, on);
  return better_of(std::move(fitted), std::move(longer));
}

double EffectFits::least_objective(const FittedModel& base, const Verdict& verdict, const Candidate& candidate) const {
  const Timesheet::Phase phase(times_, "fits", candidate.effect);
  const std::vector<Parameter> free = joined(base.free, candidate.parameters);
  const Model off = model_without(base, candidate);
  return best_start({campaign_, off, free, rows_}, fit_options(), base, candidate, verdict).best.objective;
}

/// The best of some places to start from: the effect in several amounts, each with the ground as it is and moved as the
/// score test expects it to. An amount of zero, the base itself, is one of them. Beyond an amount that is much worse
/// than none, larger ones are not tried: they would be worse still, and very slow blocks take most steps.
EffectFits::Start EffectFits::best_start(const FitProblem& problem, const FitOptions& how, const FittedModel& base,
                                         const Candidate& candidate, const Verdict& verdict) const {
  const double noticed = options_.rules.noticed;
  const VectorXd effect = start_of(candidate, verdict, noticed);
  const Index ground = std::ssize(problem.free) - effect.size();
  const double share = std::min(1.0, std::abs(effect[0]) / std::max(1e-9, noticed * std::abs(verdict.estimate[0])));
  double none = 0.0;  // the objective without the effect
  Start start;
  start.best.objective = std::numeric_limits<double>::infinity();
  for (const double amount : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    double least = std::numeric_limits<double>::infinity();
    for (const bool along : {false, true}) {
      if (along && (ground == 0 || amount == 0.0)) continue;
      VectorXd z(std::ssize(problem.free));
      if (ground > 0) z.head(ground) = base.z;
      if (along) z.head(ground) += (amount * share * verdict.ground).cwiseMax(-1.5).cwiseMin(1.5);
      z.tail(effect.size()) = amount * effect;
      Evaluation here = evaluate(problem, how, z, {how.trials});
      least = std::min(least, here.objective);
      if (here.objective < start.best.objective) start.best = std::move(here);
    }
    if (amount == 0.0) none = least;
    const bool hopeless = least > none + options_.rules.hopeless;
    if (amount <= 0.5) start.hopeless = hopeless;
    if (hopeless) break;
  }
  return start;
}

/// Gives a candidate its fit, with the values and the amount that follow from it.
void EffectFits::take_fit(FittedModel&& fitted, FittedCandidate& candidate) const {
  candidate.fitted = std::move(fitted);
  candidate.values.clear();
  for (const Parameter& p : candidate.parameters) candidate.values.push_back(p.get(candidate.fitted.model));
  set_amount(candidate, candidate.fitted.z, options_.rules);
}

void EffectFits::measure_gain(const FittedModel& base, FittedCandidate& candidate) const {
  set_gain(candidate, base.objective, candidate.fitted.objective, bootstrap_streams(campaign_));
}

/// The base as the model of a candidate at its off values.
FittedModel EffectFits::without_effect(const FittedModel& base, const Model& off, std::vector<Parameter> free,
                                       Index added) const {
  FittedModel fitted = base;
  fitted.model = off;
  fitted.z = VectorXd::Zero(std::ssize(free));
  if (std::ssize(free) > added) fitted.z.head(base.z.size()) = base.z;
  fitted.free = std::move(free);
  return fitted;
}

FittedCandidate EffectFits::fit_effect(const FittedModel& base, const EffectVerdict& verdict,
                                       const Candidate& candidate, const std::string& family) const {
  const Timesheet::Phase phase(times_, "fits", candidate.effect);
  const DiagnosisRules& rules = options_.rules;
  FittedCandidate out;
  out.effect = candidate.effect;
  out.where = candidate.where;
  out.p_value = verdict.p_value;
  out.statistic = verdict.best.statistic;
  out.parameters = candidate.parameters;
  out.tested = candidate.tested;
  const auto asked = static_cast<double>(count_of_rows(rows_));
  out.price = rules.price * (static_cast<double>(candidate.parameters.size()) + candidate.searched) / asked;
  out.place_price = rules.price * candidate.searched / asked;
  out.family = family;
  out.with_ground = !family.empty();
  std::vector<Parameter> free = joined(out.with_ground ? base.free : std::vector<Parameter>{}, candidate.parameters);
  const Index added = std::ssize(candidate.parameters);
  FitOptions how = fit_options();
  how.starts = 0;
  how.rounds = 2;
  how.enough = rules.worth_a_round;
  how.design = out.with_ground ? 4 * static_cast<int>(free.size()) : 20;
  const Model off = model_without(base, candidate);
  const Start start = best_start({campaign_, off, free, rows_}, how, base, candidate, verdict.best);
  const VectorXd& z = start.best.z;
  out.refined = out.with_ground ? !start.hopeless : !z.tail(added).isZero();
  if (!out.refined) {
    take_fit(without_effect(base, off, std::move(free), added), out);
    measure_gain(base, out);
    return out;
  }
  std::vector<Evaluation> known;
  if (out.with_ground) known = with_zero_effect(base.evaluations, added);
  how.known = known;
  how.spread = first_spread(out.with_ground ? base.spread : MatrixXd(0, 0), z.tail(added), rules.noticed);
  Fit fit = fit_parameters(campaign_, model_at(off, free, z), free, rows_, how);
  take_fit(fitted_model(std::move(fit), std::move(free)), out);
  measure_gain(base, out);
  return out;
}

/// A fit continued from where it ended, with its evaluations.
FittedModel EffectFits::continued(const FittedModel& fitted, FitOptions how) const {
  how.starts = 0;
  how.spread = fitted.spread;
  how.known = fitted.evaluations;
  return fitted_model(fit_parameters(campaign_, fitted.model, fitted.free, rows_, how), fitted.free);
}

FitOptions EffectFits::continued_fit_options(const FittedModel& fitted) const {
  FitOptions how = fit_options();
  how.rounds = 3;
  how.enough = options_.rules.worth_a_round;
  how.design = 6 * static_cast<int>(fitted.free.size());
  return how;
}

void EffectFits::continue_fit(const FittedModel& base, FittedCandidate& candidate) const {
  const Timesheet::Phase phase(times_, "fits", candidate.effect);
  continue_with(base, candidate, continued_fit_options(candidate.fitted));
}

void EffectFits::continue_with_more_trials(const FittedModel& base, FittedCandidate& candidate) const {
  const Timesheet::Phase phase(times_, "fits", candidate.effect);
  FitOptions how = fit_options();
  how.trials *= 2;
  how.comparison_trials *= 2;
  how.rounds = 2;
  continue_with(base, candidate, how);
}

void EffectFits::complete(const FittedModel& base, FittedCandidate& chosen) const {
  const Timesheet::Phase phase(times_, "chosen model");
  FitOptions how = last_fit_options(fit_options(), options_.rules);
  const FittedModel& fitted = chosen.fitted;
  how.known = fitted.evaluations;
  FittedModel longer = fitted_model(fit_parameters(campaign_, fitted.model, fitted.free, rows_, how), fitted.free);
  take_fit(better_of(std::move(chosen.fitted), std::move(longer)), chosen);
  measure_gain(base, chosen);
}

void EffectFits::continue_with(const FittedModel& base, FittedCandidate& candidate, const FitOptions& how) const {
  FittedModel longer = continued(candidate.fitted, how);
  take_fit(better_of(std::move(candidate.fitted), std::move(longer)), candidate);
  measure_gain(base, candidate);
}

std::vector<Score> EffectFits::cross_validated(const FittedModel& fitted, Judges judges) const {
  const FitProblem problem{campaign_, fitted.model, fitted.free, rows_};
  const FitOptions how = fit_options();
  return OutOfFold(problem, how, fitted).objectives(options_, first_trial_of(options_, round_), judges);
}

std::vector<BlockRuns> EffectFits::out_of_fold(const FittedModel& fitted, std::span<const std::uint32_t> fold_of,
                                               std::size_t folds, ObserveOptions how) const {
  const FitProblem problem{campaign_, fitted.model, fitted.free, rows_};
  const FitOptions options = fit_options();
  return OutOfFold(problem, options, fitted).runs(std::move(how), fold_of, folds).front();
}

Confirmation EffectFits::confirmation(const FittedModel& base, const FittedCandidate& candidate) const {
  const Timesheet::Phase phase(times_, "confirmation");
  const DiagnosisRules& rules = options_.rules;
  const Difference change =
      mean_difference(cross_validated(base, Judges::Confirmation),
                      cross_validated(candidate.fitted, Judges::Confirmation), bootstrap_streams(campaign_));
  ObserveOptions unseen = observe_options(rules.confirming * options_.trials.compare);
  unseen.first_trial += (1 + 2 * rules.fold_orders) * options_.trials.compare;
  const auto error = [&](const FittedModel& fitted) {
    const auto runs = observe(campaign_, fitted.model, unseen);
    return weigh_groups(score(campaign_, runs, rows_, fit_scoring(rules.confirming * kFewestSimulated))).total;
  };
  return {error(base) - error(candidate.fitted), -change.mean - candidate.place_price};
}

}  // namespace talus
