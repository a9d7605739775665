#include "talus/fit/diagnose/score_test.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "null_scores.hpp"
#include "talus/fit/diagnose/candidates.hpp"
#include "talus/fit/diagnose/corrected.hpp"
#include "talus/fit/diagnose/projection.hpp"
#include "talus/fit/diagnose/residual.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The smallest p-value over the places of each effect, in data sets without an effect.
std::vector<std::vector<double>> smallest_drawn(std::size_t effects, const std::vector<Projection>& projections,
                                                const std::vector<std::size_t>& effect_of, const MatrixXd& sets,
                                                const ScoreTestOptions& options) {
  std::vector<std::vector<double>> smallest(effects, std::vector<double>(static_cast<std::size_t>(sets.cols()), 1.0));
  for (Index set = 0; set < sets.cols(); ++set) {
    if (set % 1000 == 999 && options.proceed && !options.proceed()) throw FitInterrupted{};
    const VectorXd scores = sets.col(set);
    for (std::size_t i = 0; i < projections.size(); ++i) {
      double& best = smallest[effect_of[i]][static_cast<std::size_t>(set)];
      best = std::min(best, projections[i].verdict(scores).p_value);
    }
  }
  return smallest;
}

void correct(ScoreTest& test, std::vector<std::vector<double>> simulated) {
  std::vector<double> measured;
  for (const EffectVerdict& effect : test.effects) measured.push_back(effect.best.p_value);
  const Corrected p = corrected(simulated, measured);
  for (std::size_t e = 0; e < test.effects.size(); ++e) {
    test.effects[e].p_value = p.effects[e];
    test.effects[e].drawn = std::move(simulated[e]);
  }
  test.p_value = p.all;
}

/// Whether a is more significant; by the statistic where both p-values are too small for a double.
bool more_significant(const Verdict& a, const Verdict& b) {
  return a.p_value != b.p_value ? a.p_value < b.p_value : a.statistic > b.statistic;
}

/// Keeps a further place of an effect if it is the best or the second best.
void rank(const Verdict& verdict, EffectVerdict& effect) {
  if (more_significant(verdict, effect.best)) {
    effect.second = std::exchange(effect.best, verdict);
  } else if (effect.second.members.empty() || more_significant(verdict, effect.second)) {
    effect.second = verdict;
  }
}

/// Keeps how well a place of an effect measures its parameters, and which of the places measures each best.
void sharpen(const Eigen::VectorXd& errors, const std::vector<std::size_t>& members, const Candidate& candidate,
             EffectVerdict& effect) {
  for (Index p = 0; p < errors.size(); ++p) {
    const auto parameter = static_cast<std::size_t>(p);
    const Precision here{members, parameter, errors[p]};
    Precision& sharpest = effect.sharpest[candidate.parameters[parameter].key];
    if (here.standard_error < sharpest.standard_error) sharpest = here;
    if (members.size() == 1) effect.places.push_back(here);
  }
}

/// Adds the direction of the factor on the radius at an impact (`shape`), which no fit moves: a ground of another one
/// must not be taken for an effect.
void add_shape(Directions& directions, const Model& base, const DiagnosisRules& rules, const Observer& observed) {
  Model moved = base;
  for (Ground& ground : moved.grounds) ground.shape_max += rules.other_shape;
  directions.add(observed(moved));
}

/// Adds the directions of the candidates.
void add_candidates(Directions& directions, const Model& base, std::span<const Candidate> candidates,
                    const DiagnosisRules& rules, const Observer& observed) {
  for (const Candidate& candidate : candidates)
    for (std::size_t p = 0; p < candidate.tested; ++p) {
      VectorXd moved = VectorXd::Zero(static_cast<Index>(candidate.parameters.size()));
      moved[static_cast<Index>(p)] = rules.noticed;
      directions.add(observed(with(base, candidate, moved)));
    }
}

/// Runs of the asked blocks with the random numbers of the test.
TrialObserver trials_of(const Campaign& campaign, const std::vector<bool>& rows, const ScoreTestOptions& options) {
  return [&](const Model& model, std::uint32_t trials, std::uint32_t first) {
    if (options.proceed && !options.proceed()) throw FitInterrupted{};
    return observe(campaign, model,
                   {.trials = trials,
                    .seed = options.seed,
                    .first_trial = first,
                    .threads = options.threads,
                    .blocks = rows,
                    .effort = effort_of(options.rules.search),
                    .traced = options.traced});
  };
}

/// Runs for the signatures: every model has the same trials.
Observer observer_of(const Campaign& campaign, const std::vector<bool>& rows, const ScoreTestOptions& options) {
  return [trials = options.trials, observed = trials_of(campaign, rows, options)](const Model& model) {
    return observed(model, trials, 0);
  };
}

/// The scores of the free parameters of a model.
struct OwnScores {
  VectorXd move;           ///< the Newton step, from where the model is [z]
  double statistic = 0.0;  ///< s' I^-1 s
};

/// @param moved  from the fit, at which the prior is centred [z]
OwnScores own_scores(const Campaign& campaign, const TestedModel& at, const VectorXd& moved,
                     const std::vector<bool>& rows, const Observer& observed, const DiagnosisRules& rules) {
  const ResidualSpace space(campaign, at.runs, rules);
  Directions directions(campaign, space, at.runs, observed(at.model), rows);
  const VectorXd steps = directions.add_free(at, observed, rules);
  const CampaignScores scores = directions.scores();
  MatrixXd information = covariance_of(scores.trials);
  information.diagonal().array() += step_prior(rules);
  const Eigen::LDLT<MatrixXd> solver(information);
  const VectorXd pull = step_prior(rules) * moved.cwiseQuotient(steps);
  return {steps.cwiseProduct(solver.solve(scores.measured - pull)), scores.measured.dot(solver.solve(scores.measured))};
}

}  // namespace

SettledModel settled_model(const Campaign& campaign, const TestedModel& fitted, const std::vector<bool>& rows,
                           const ScoreTestOptions& options, const Observer& simulated) {
  const Observer observed = observer_of(campaign, rows, options);
  const DiagnosisRules& rules = options.rules;
  SettledModel here{fitted.model, fitted.z, fitted.runs}, best = here;
  VectorXd move;  // from the best place
  for (int step = 0; fitted.z.size() > 0; ++step) {
    const OwnScores own = own_scores(campaign, here.tested(fitted.free), here.z - fitted.z, rows, observed, rules);
    here.statistic = own.statistic;
    if (step == 0) here.statistic_of_fit = own.statistic;
    if (step == 0 || here.statistic < best.statistic) {
      best = here;
      move = own.move * std::min(1.0, rules.longest_move / own.move.cwiseAbs().maxCoeff());
    } else {
      move *= 0.5;  // too far: the signatures are those of small changes
    }
    if (step == rules.settling || best.statistic < rules.settled * static_cast<double>(here.z.size())) break;
    for (Index i = 0; i < here.z.size(); ++i)
      here.z[i] = fitted.free[static_cast<std::size_t>(i)].within(best.z[i] + move[i]);
    if (here.z == best.z) break;
    here.model = model_at(fitted.model, fitted.free, here.z);
    here.runs = simulated(here.model);
  }
  return best;
}

ScoreTest score_test(const Campaign& campaign, const TestedModel& base, std::span<const Candidate> candidates,
                     const std::vector<bool>& rows, const ScoreTestOptions& options) {
  const Observer observed = observer_of(campaign, rows, options);
  const DiagnosisRules& rules = options.rules;
  const ResidualSpace space(campaign, base.runs, rules);
  Directions directions(campaign, space, base.runs, observed(base.model), rows);
  const VectorXd steps = directions.add_free(base, observed, rules);
  add_shape(directions, base.model, rules, observed);
  const Index of_base = directions.size();
  add_candidates(directions, base.model, candidates, rules, observed);
  const CampaignScores scores = directions.scores();
  const MatrixXd covariance = covariance_of(scores.trials);
  const OpenGrounds grounds(base, steps, scores, covariance, rules);
  const MatrixXd residuals = directions.measured();
  const Scatters scatters(campaign, space, directions.blocks(), residuals);
  const NullSets null =
      null_sets(grounds, directions, scores.means, scatters, trials_of(campaign, rows, options), options);
  const VectorXd measured = scores.measured - null.mean;
  ScoreTest test;
  test.dispersion = dispersion_test(scatters.kinds(), null.scatters, scatters.of(residuals));
  std::vector<Projection> projections;
  std::vector<std::size_t> effect_of;
  for (const TestedPlace& place : places_of(candidates, of_base, directions.size(), rules)) {
    projections.emplace_back(place, covariance, of_base, steps, step_prior(rules));
    Verdict verdict = projections.back().verdict(measured);
    verdict.members = place.members;
    const std::string& name = candidates[place.members.front()].effect;
    auto effect = std::find_if(test.effects.begin(), test.effects.end(),
                               [&](const EffectVerdict& e) { return e.effect == name; });
    if (effect == test.effects.end())
      effect = test.effects.insert(effect, {name, verdict, {}, 1.0, {}, {}, {}});
    else
      rank(verdict, *effect);
    sharpen(projections.back().standard_errors(), place.members, candidates[place.members.front()], *effect);
    effect_of.push_back(static_cast<std::size_t>(effect - test.effects.begin()));
  }
  correct(test, smallest_drawn(test.effects.size(), projections, effect_of, null.scores, options));
  std::ranges::stable_sort(test.effects, [](const EffectVerdict& a, const EffectVerdict& b) {
    return a.p_value != b.p_value ? a.p_value < b.p_value : more_significant(a.best, b.best);
  });
  return test;
}

SettledTest settled_test(const Campaign& campaign, const TestedModel& fitted, std::span<const Candidate> candidates,
                         const std::vector<bool>& rows, const ScoreTestOptions& options, const Observer& simulated) {
  SettledTest out{settled_model(campaign, fitted, rows, options, simulated), {}};
  out.test = score_test(campaign, out.model.tested(fitted.free), candidates, rows, options);
  for (EffectVerdict& effect : out.test.effects)
    for (Verdict* verdict : {&effect.best, &effect.second})
      if (verdict->ground.size() > 0) verdict->ground += out.model.z - fitted.z;
  return out;
}

}  // namespace talus
