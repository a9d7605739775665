#include "joint_fits.hpp"

#include <algorithm>
#include <limits>

#include "talus/fit/diagnose/candidates.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint32_t kFirstRound = 20;  // the rounds of the sites' own fits lie before it

/// A matrix with another one after its last row and column.
MatrixXd extended(const MatrixXd& first, const MatrixXd& second) {
  MatrixXd all = MatrixXd::Zero(first.rows() + second.rows(), first.cols() + second.cols());
  all.topLeftCorner(first.rows(), first.cols()) = first;
  all.bottomRightCorner(second.rows(), second.cols()) = second;
  return all;
}

VectorXd extended(const VectorXd& first, const VectorXd& second) {
  VectorXd all(first.size() + second.size());
  all << first, second;
  return all;
}

std::vector<std::string> names_of(std::span<const Site> sites) {
  std::vector<std::string> names;
  for (const Site& site : sites) names.push_back(site.name);
  return names;
}

/// The parameters of a candidate by site.
std::vector<std::vector<Parameter>> parameters_of(const SiteCandidates& candidate) {
  std::vector<std::vector<Parameter>> own;
  for (const std::optional<Candidate>& c : candidate) own.push_back(c ? c->parameters : std::vector<Parameter>{});
  return own;
}

/// The models prepared for a candidate, whose parameters are still zero.
std::vector<Model> models_without(const JointModel& base, const SiteCandidates& candidate) {
  std::vector<Model> models;
  for (std::size_t i = 0; i < candidate.size(); ++i)
    models.push_back(candidate[i]
                         ? with(base.models[i], *candidate[i], VectorXd::Zero(std::ssize(candidate[i]->parameters)))
                         : base.models[i]);
  return models;
}

const Candidate& first_of(const SiteCandidates& candidate) {
  return **std::ranges::find_if(candidate, [](const std::optional<Candidate>& c) { return c.has_value(); });
}

}  // namespace

JointFits::JointFits(std::span<const Site> sites, const DiagnoseOptions& options, std::function<bool(double)> proceed)
    : sites_(sites), options_(options), proceed_(std::move(proceed)) {
  for (const Site& site : sites_) {
    rows_.push_back(fitting_rows(*site.campaign));
    const std::vector<std::uint32_t> own = bootstrap_streams(*site.campaign, site.name);
    streams_.insert(streams_.end(), own.begin(), own.end());
  }
}

std::size_t JointFits::blocks() const {
  std::size_t count = 0;
  for (const std::vector<bool>& rows : rows_) count += count_of_rows(rows);
  return count;
}

FitProblem JointFits::problem_of(const JointParameters& parameters, const std::vector<Model>& start) const {
  std::vector<FitSite> list;
  for (std::size_t i = 0; i < sites_.size(); ++i)
    list.push_back({sites_[i].name, *sites_[i].campaign, start[i], rows_[i], parameters.sites[i]});
  return {std::move(list), parameters.free};
}

FitOptions JointFits::fit_options() const {
  FitOptions how = search_options(options_, proceed_);
  how.starts = 0;
  how.enough = options_.rules.worth_a_round;
  return how;
}

std::uint32_t JointFits::first_trial() const {
  return first_trial_of(options_, kFirstRound + round_);
}

std::vector<std::vector<BlockRuns>> JointFits::observe_all(const std::vector<Model>& models, std::uint32_t trials,
                                                           std::uint32_t first) const {
  std::vector<std::vector<BlockRuns>> runs;
  for (std::size_t i = 0; i < sites_.size(); ++i)
    runs.push_back(
        observe(*sites_[i].campaign, models[i],
                {trials, options_.seed, first, options_.threads, rows_[i], {}, effort_of(options_.rules.search)}));
  return runs;
}

JointModel JointFits::simulated_anew(JointModel fitted) const {
  fitted.runs = observe_all(fitted.models, options_.trials.compare, first_trial());
  const FitProblem problem = problem_of(fitted.parameters, fitted.models);
  fitted.score = joined_score(problem, fitted.runs, {});
  fitted.objective = weigh_groups(joined_score(problem, fitted.runs, fit_scoring()));
  return fitted;
}

JointModel JointFits::begin_round(JointModel base) {
  ++round_;
  return simulated_anew(std::move(base));
}

JointModel JointFits::fitted(const FitProblem& problem, const JointParameters& parameters,
                             const FitOptions& how) const {
  Fit fit = fit_parameters(problem, how);
  if (fit.interrupted) throw FitInterrupted{};
  JointModel out;
  out.models = problem.models(fit.z);
  out.parameters = parameters;
  out.z = std::move(fit.z);
  out.spread = std::move(fit.spread);
  out.evaluations = std::move(fit.evaluations);
  return simulated_anew(std::move(out));
}

/// A fit continued from where it ended; the better one, with the evaluations of both.
JointModel JointFits::continued(JointModel before, int rounds, std::uint32_t times_trials) const {
  FitOptions how = fit_options();
  how.trials *= times_trials;
  how.comparison_trials *= times_trials;
  how.rounds = rounds;
  how.design = 6 * static_cast<int>(before.z.size());
  how.spread = before.spread;
  how.known = before.evaluations;
  JointModel longer = fitted(problem_of(before.parameters, before.models), before.parameters, how);
  return better_of(std::move(before), std::move(longer));
}

void JointFits::complete(const JointModel& base, JointCandidate& chosen) const {
  FitOptions how = last_fit_options(fit_options(), options_.rules);
  how.known = chosen.fitted.evaluations;
  const JointModel& before = chosen.fitted;
  JointModel longer = fitted(problem_of(before.parameters, before.models), before.parameters, how);
  take_fit(base, better_of(std::move(chosen.fitted), std::move(longer)), chosen);
}

JointModel JointFits::fit_ground(std::span<const SiteDiagnosis> sites) const {
  std::vector<std::vector<Parameter>> own;
  JointModel ground;
  ground.z.resize(0);
  ground.spread.resize(0, 0);
  for (const SiteDiagnosis& site : sites) {
    own.push_back(site.base.free);
    ground.models.push_back(site.base.model);
    ground.z = extended(ground.z, site.base.z);
    ground.spread = extended(ground.spread, site.base.spread);
  }
  ground.parameters = joint_parameters(names_of(sites_), own, {});
  return continued(continued(simulated_anew(std::move(ground)), 3, 1), 2, 2);
}

Evaluation JointFits::best_start(const JointModel& base, const SiteCandidates& candidate,
                                 std::span<const VectorXd> estimates) const {
  const JointParameters parameters = with_shared(base.parameters, parameters_of(candidate));
  const std::vector<Model> off = models_without(base, candidate);
  const FitProblem problem = problem_of(parameters, off);
  const FitOptions how = fit_options();
  const Index ground = base.z.size(), own = std::ssize(parameters.free) - ground;
  Evaluation best;
  best.objective = std::numeric_limits<double>::infinity();
  for (const VectorXd& estimate : estimates)
    for (const double amount : {0.5, 1.0, 2.0, 4.0}) {
      VectorXd effect = VectorXd::Zero(own);
      for (Index i = 0; i < std::min(own, estimate.size()); ++i) {
        const Parameter& p = parameters.free[static_cast<std::size_t>(ground + i)];
        effect[i] = p.within(options_.rules.noticed * amount * first_amount(p, estimate[i]));
      }
      Evaluation here = evaluate(problem, how, extended(base.z, effect), {how.trials});
      if (here.objective < best.objective) best = std::move(here);
    }
  return best;
}

JointCandidate JointFits::fit_effect(const JointModel& base, const SiteCandidates& candidate,
                                     const VectorXd& start) const {
  const DiagnosisRules& rules = options_.rules;
  const Candidate& first = first_of(candidate);
  const JointParameters parameters = with_shared(base.parameters, parameters_of(candidate));
  const Index ground = base.z.size(), own = start.size() - ground;
  JointCandidate out;
  out.effect = first.effect;
  out.where = first.where;
  out.parameters.assign(parameters.free.begin() + ground, parameters.free.end());
  out.tested = first.tested;
  out.price = rules.price * static_cast<double>(own) / static_cast<double>(blocks());
  std::vector<Evaluation> known = base.evaluations;
  for (Evaluation& e : known) e.z = extended(e.z, VectorXd::Zero(own));
  const VectorXd reach = (0.5 * start.tail(own)).cwiseAbs().cwiseMax(0.5 * rules.noticed).cwiseAbs2();
  FitOptions how = fit_options();
  how.rounds = 2;
  how.design = 4 * static_cast<int>(start.size());
  how.known = known;
  how.spread = extended(base.spread, MatrixXd(reach.asDiagonal()));
  std::vector<Model> off = models_without(base, candidate);
  off = problem_of(parameters, off).models(start);
  take_fit(base, continued(continued(fitted(problem_of(parameters, off), parameters, how), 3, 1), 2, 2), out);
  return out;
}

/// Gives a candidate its fit, with the values, the amount and the gain that follow from it.
void JointFits::take_fit(const JointModel& base, JointModel&& fitted, JointCandidate& candidate) const {
  candidate.fitted = std::move(fitted);
  const std::vector<Parameter>& own = candidate.parameters;
  const VectorXd z = candidate.fitted.z.tail(std::ssize(own));
  candidate.values.clear();
  for (std::size_t i = 0; i < own.size(); ++i) candidate.values.push_back(own[i].value(z[static_cast<Index>(i)]));
  set_amount(candidate, candidate.fitted.z, options_.rules);
  set_gain(candidate, base.objective, candidate.fitted.objective, streams_);
}

std::vector<Score> JointFits::cross_validated(const JointModel& fitted, Judges judges) const {
  const FitProblem problem = problem_of(fitted.parameters, fitted.models);
  const FitOptions how = fit_options();
  return OutOfFold(problem, how, fitted).objectives(options_, first_trial(), judges);
}

Confirmation JointFits::confirmation(const JointModel& base, const JointCandidate& candidate) const {
  const DiagnosisRules& rules = options_.rules;
  const Difference change = mean_difference(cross_validated(base, Judges::Confirmation),
                                            cross_validated(candidate.fitted, Judges::Confirmation), streams_);
  const std::uint32_t first = first_trial() + (1 + 2 * rules.fold_orders) * options_.trials.compare;
  const auto error = [&](const JointModel& fitted) {
    const auto runs = observe_all(fitted.models, rules.confirming * options_.trials.compare, first);
    return weigh_groups(joined_score(problem_of(fitted.parameters, fitted.models), runs,
                                     fit_scoring(rules.confirming * kFewestSimulated)))
        .total;
  };
  return {error(base) - error(candidate.fitted), -change.mean};
}

}  // namespace talus
