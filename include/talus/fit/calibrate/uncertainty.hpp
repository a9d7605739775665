#pragma once
#include "talus/fit/calibrate/fit_problem.hpp"

namespace talus {

/// Uncertainty of the parameters of a fit.
struct Uncertainty {
  Eigen::MatrixXd draws;            ///< one z per row; size: draws x free parameters
  std::vector<Interval> intervals;  ///< 95 %, of the values in the units of the files
  std::vector<bool> identifiable;   ///< false: the interval covers most of the prior's
  std::vector<bool> at_bound;       ///< true: the interval ends where the search does (`Parameter::reach`)
  Eigen::MatrixXd correlation;      ///< of z over the draws; size: parameters x parameters
  double noise = 0.0;               ///< standard deviation of a total with FitOptions::trials, from its random numbers
  bool interrupted = false;
};

/// Number of free parameters; one that the prior holds counts for less. The sum of 1 - variance of z, as the prior has
/// a variance of 1. On its own rows a fit gains as much as one of so many parameters without a prior.
double effective_numbers(const Uncertainty& uncertainty);

/// A parameter is called not identifiable where its 95 % interval is wider than this share of the prior's, or of the
/// bounds where these are narrower.
inline constexpr double kMostOfThePrior = 0.5;

struct UncertaintyOptions {
  int rounds = 3;  ///< of new evaluations where the draws lie
  int draws = 400;
};

/// Posterior sample by randomised minimisation (randomise, then optimise): each draw gives the blocks random
/// weights (`bootstrap_weights`), draws the centre of the prior from the prior, adds the noise of the trials, and moves
/// the optimum of the fit to the new minimum within the bounds. The objective is a quadratic model of every row score
/// around the optimum (`LocalModel`), so that a draw costs no simulation. The model is fitted to rounds of designs;
/// each is as wide as the range in which the previous round found the objective nearly as good.
///
/// @param fit  of the same problem
///
/// Includes the choice of the released blocks, the prior and the noise of the simulation. Leaves out that the model may
/// be wrong. docs/closing-the-loop.md, "Uncertainty".
Uncertainty uncertainty_of(const FitProblem& problem, const FitOptions& options, const UncertaintyOptions& how,
                           const Fit& fit);

}  // namespace talus
