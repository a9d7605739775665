#pragma once
#include <functional>
#include <string>

#include "talus/fit/score/score.hpp"

namespace talus {

/// A number of a model that is fitted. The search moves in z, its distance from `centre` in units of `sd`:
///
///   log scale:    value = centre exp(sd z)          linear scale:  value = centre + sd z
///
/// and takes z as standard normal beforehand: the weak prior.
struct Parameter {
  enum class Scale { Log, Linear };

  std::string key;                  ///< "ground.zones.talus.En50"
  std::string unit;                 ///< "m3/s2"; empty where there is none
  double lower = 0.0, upper = 0.0;  ///< bounds, in the units of the files; log scale: above 0
  Scale scale = Scale::Log;
  double centre = 1.0;  ///< of the prior, within the bounds
  double sd = 1.0;      ///< of the prior: of the logarithm, or in the unit of the value
  std::function<double(const Model&)> get;
  std::function<void(Model&, double)> set;

  double value(double z) const;
  double z(double value) const;
};

/// The parameters `keys` of ground_fields() in the given zones, with the start as centre of the prior. theta_scale,
/// psi_scale, En50 and Et50 on the log scale with sd 1 (a factor of e), phi on the linear one with sd 8 degrees; bounds
/// 2.5 sd from the start, and those of the field. Throws InputError for a key that cannot be fitted, and
/// where there is no such zone.
std::vector<Parameter> ground_parameters(const Campaign& campaign, const Model& start,
                                         std::span<const std::string> keys, const std::vector<bool>& zones);

/// The zones that enough simulated paths of the asked blocks touch: at least `share` of them. Size: zones of the
/// campaign; a zone counts with the bands of other ground that a model has laid over it.
std::vector<bool> touched_zones(const Campaign& campaign, std::span<const BlockRuns> runs, double share = 0.05);

/// What one model scored, row by row.
struct Evaluation {
  Eigen::VectorXd z;     ///< size: free parameters
  Eigen::VectorXd rows;  ///< as Score::rows of the fit
  std::uint32_t trials;
  double objective;
};

struct FitOptions {
  std::uint32_t trials = 48;              ///< per block while it searches
  std::uint32_t comparison_trials = 200;  ///< per block where the best of a few places is taken
  int starts = 3;                         ///< of searches; 0: none, rounds of the quadratic model from the start
  int rounds = 5;                         ///< of the quadratic model, at most
  int design = 0;                         ///< evaluations of each round; 0: by the number of parameters
  double enough = 0.0;                    ///< a round that lowers the objective by less is the last one
  std::uint64_t seed = 1;
  int threads = 0;
  double prior_weight = 0.28;              ///< see Fit::objective and docs/closing-the-loop.md; 0: no prior
  Eigen::MatrixXd spread;                  ///< covariance of the first round's places, in z; empty: a usual one
  std::span<const Evaluation> known = {};  ///< of the same parameters and rows: the quadratic model learns from it
  std::function<bool(double)> proceed;     ///< told the share done, 0..1; false ends the fit. May be empty
};

/// The model that was found.
struct Fit {
  Model model;
  Eigen::VectorXd z;             ///< of the free parameters
  double objective = kNotGiven;  ///< total of the weighed groups + prior_weight / (blocks asked for) * sum of z^2
  Score score;                   ///< of the asked rows, with comparison_trials trials, its groups weighed
  Eigen::MatrixXd spread;        ///< covariance of z within which the objective is nearly as good
  std::vector<Evaluation> evaluations;  ///< of the designs, and what was known: what the quadratic model learns from
  int tried = 0;                        ///< places that were simulated, those of the searches and comparisons too
  bool interrupted = false;
};

/// Fits the free parameters to the asked rows of a campaign.
///
/// @param start  what is not free stays as it is there
/// @param free   at least one
/// @param rows   which blocks are used; size: blocks. Spreads come from all fitting rows
///
/// Minimises the mean normalised score, its groups weighed (`weigh_groups`), plus the prior with NLopt's LN_BOBYQA
/// (Powell 2009; quadratic models, no derivatives) from the start and from the best of a low-discrepancy set. The luck
/// of the trials ends such a search early; rounds of a least-squares quadratic model around the best point
/// (`LocalModel`) go on from there. Places are compared on luck of their own: the lowest of many noisy values is too
/// low. The same result for any number of threads.
Fit fit_parameters(const Campaign& campaign, const Model& start, std::span<const Parameter> free,
                   const std::vector<bool>& rows, const FitOptions& options);

/// What is fitted to what. The parts must outlive it.
struct FitProblem {
  const Campaign& campaign;
  const Model& start;               ///< what is not free stays as it is there
  std::span<const Parameter> free;  ///< at least one
  const std::vector<bool>& rows;    ///< blocks that are used; size: blocks

  double prior(const FitOptions& options) const;  ///< weight of z^2 in the objective
};

/// Which trials of every block are simulated.
struct Trials {
  std::uint32_t count, first = 0;
};

/// The objective at one point. Equal trials: compared on the same luck.
Evaluation evaluate(const FitProblem& problem, const FitOptions& options, const Eigen::VectorXd& z,
                    const Trials& trials);

/// A model with the free parameters at z.
Model model_at(const Model& start, std::span<const Parameter> free, const Eigen::VectorXd& z);

}  // namespace talus
