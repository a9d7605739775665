#pragma once
#include "talus/fit/calibrate/parameters.hpp"
#include "talus/fit/calibrate/search_rules.hpp"
#include "talus/fit/score/score.hpp"

namespace talus {

/// The score of one model, row by row.
struct Evaluation {
  Eigen::VectorXd z;     ///< size: free parameters
  Eigen::VectorXd rows;  ///< scores, in the order of Score::rows of the fit
  std::uint32_t trials;
  double objective;
};

struct FitOptions {
  std::uint32_t trials = 48;              ///< per block while it searches
  std::uint32_t comparison_trials = 200;  ///< per block when the best of a few places is chosen
  int starts = 3;                         ///< number of searches; 0: only rounds of the quadratic model, from the start
  int rounds = 5;                         ///< of the quadratic model, at most
  int design = 0;                         ///< evaluations of each round; 0: by the number of parameters
  double enough = 0.0;                    ///< a round that lowers the objective by less is the last one
  std::uint64_t seed = 1;
  int threads = 0;
  double prior_weight = 0.28;              ///< see Fit::objective and docs/closing-the-loop.md; 0: no prior
  Eigen::MatrixXd spread;                  ///< covariance of the first round's places, in z; empty: by `rules`
  std::span<const Evaluation> known = {};  ///< evaluations of the same parameters and rows, for the quadratic model
  SearchRules rules;                       ///< numbers that no user sets
  std::function<bool(double)> proceed;     ///< receives the share done, 0..1; false ends the fit. May be empty
  TracedVertices* traced = nullptr;        ///< as in ObserveOptions
};

/// The result of a fit.
struct Fit {
  Model model;                   ///< of the first site where there are several: FitProblem::models(z) gives all
  Eigen::VectorXd z;             ///< of the free parameters
  double objective = kNotGiven;  ///< total of the weighed groups + prior_weight / (blocks asked for) * sum of z^2
  Score score;                   ///< of the asked rows, with comparison_trials trials, its groups weighed
  Eigen::MatrixXd spread;        ///< covariance of z within which the objective is nearly as good
  std::vector<Evaluation> evaluations;  ///< of the designs, and FitOptions::known: data of the quadratic model
  int tried = 0;                        ///< number of simulated places, searches and comparisons included
  bool interrupted = false;
};

/// How a number of the search sets the model of one campaign.
struct SiteParameter {
  std::size_t number;  ///< index into FitProblem::free
  std::function<double(const Model&)> get;
  std::function<void(Model&, double)> set;
};

/// A campaign and the model that is fitted to it. The parts must outlive it.
struct FitSite {
  std::string name;  ///< stands before its groups; empty where it is the only one
  const Campaign& campaign;
  const Model& start;             ///< parameters that are not free keep its values
  const std::vector<bool>& rows;  ///< blocks that are used; size: blocks
  std::vector<SiteParameter> parameters;
};

/// A model and the measurements that it is fitted to: one campaign, or several whose models have numbers of their own
/// and shared ones. The parts must outlive it. docs/several-campaigns.md.
struct FitProblem {
  /// One campaign, whose model has all free parameters.
  FitProblem(const Campaign& campaign, const Model& start, std::span<const Parameter> free,
             const std::vector<bool>& rows);
  /// Several campaigns. `get` and `set` of the free parameters are not used: each site has its own.
  FitProblem(std::vector<FitSite> sites, std::span<const Parameter> free);

  std::vector<FitSite> sites;       ///< at least one
  std::span<const Parameter> free;  ///< at least one

  double prior(const FitOptions& options) const;  ///< weight of z^2 in the objective
  std::vector<bool> rows() const;                 ///< of all sites, one after the other
  std::vector<std::uint32_t> streams() const;     ///< of their blocks, in the same order
  Eigen::VectorXd start() const;                  ///< z of the start, within the bounds
  Model model(const FitSite& site, const Eigen::VectorXd& z) const;
  std::vector<Model> models(const Eigen::VectorXd& z) const;  ///< by site
};

/// The trials of every block that are simulated.
struct TrialRange {
  std::uint32_t count, first = 0;
};

/// The score that the objective is made of, its groups weighed: of all sites together.
///
/// @param fewest  simulated values with which a row is scored
Score score_at(const FitProblem& problem, const FitOptions& options, const Eigen::VectorXd& z, const TrialRange& trials,
               std::size_t fewest = kFewestSimulated);

/// The objective at one place. Two places with the same trials are compared with the same random numbers.
Evaluation evaluate(const FitProblem& problem, const FitOptions& options, const Eigen::VectorXd& z,
                    const TrialRange& trials);

}  // namespace talus
