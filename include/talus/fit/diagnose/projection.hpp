#pragma once
#include <vector>

#include "talus/fit/diagnose/candidate.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"
#include "talus/fit/diagnose/verdict.hpp"

namespace talus {

/// A place where an effect is tested: the candidates whose signatures are summed up, and their directions.
struct TestedPlace {
  std::vector<std::size_t> members;  ///< indices into the candidates; all of one effect
  Eigen::MatrixXd pick;              ///< directions x tested parameters
  std::vector<bool> one_sided;       ///< by tested parameter: it cannot be below zero
};

/// Every place of every candidate: alone; neighbouring bands joined; sets of days. The first `base` directions
/// are those of the base, then come the tested ones of each candidate in turn.
std::vector<TestedPlace> places_of(std::span<const Candidate> candidates, Eigen::Index base, Eigen::Index directions,
                                   const DiagnosisRules& rules);

/// The linear map from scores to the effective score of one place: without the part that the free parameters of the
/// base explain, by a regression on their scores. The prior of the base is centred where the base is: a ground that its
/// prior held back is free to go on.
class Projection {
 public:
  /// @param covariance  of the scores of one data set under the model; directions x directions
  /// @param base        number of the first directions, those of the base: its parameters, then the upper limit of
  /// `shape`
  /// @param steps       by which the base's parameters were moved [z]
  /// @param prior       precision of a step of the base
  Projection(const TestedPlace& place, const Eigen::MatrixXd& covariance, Eigen::Index base,
             const Eigen::VectorXd& steps, double prior);

  /// @param scores  by direction, summed over the blocks
  ///
  /// The estimate is the best one within its bounds, the statistic that of Rao, with the variance that the model gives.
  /// Its distribution is taken as chi-bar squared (chi_bar_tail): p-values that are reported come from data sets of the
  /// model, which go through the same choice. (The scatter of the blocks themselves is no variance for it: a fit to
  /// these blocks makes it less than that of drawn data sets.)
  Verdict verdict(const Eigen::VectorXd& scores) const;

  /// Standard error of the estimate of each tested parameter if it alone is not zero, in units of its step; under the
  /// model, with the base free to move along.
  Eigen::VectorXd standard_errors() const { return information_.diagonal().cwiseSqrt().cwiseInverse(); }

 private:
  Eigen::MatrixXd map_;  // tested parameters x directions
  Eigen::MatrixXd information_;
  Eigen::VectorXd steps_;
  std::vector<bool> one_sided_;
  double bounded_correlation_ = 0.0;  // of the estimates, if two are bounded
};

/// Probability that s' I^-1 s of the best estimates within their bounds is above `statistic` if there is no effect: a
/// mixture of chi squared distributions (chi-bar squared).
///
/// @param freedom      number of estimates
/// @param bounded      those that cannot be below zero
/// @param correlation  of the estimates (not of their scores), if two are bounded: the weights are then exact. Of three
///                     and more they are those of uncorrelated ones.
double chi_bar_tail(double statistic, Eigen::Index freedom, int bounded, double correlation);

}  // namespace talus
