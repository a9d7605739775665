#pragma once
#include <Eigen/Cholesky>
#include <functional>

#include "directions.hpp"
#include "talus/fit/diagnose/dispersion.hpp"

namespace talus {

/// Grounds that the measurements leave open: normal about the best one, with the precision of the scores and of the
/// prior. Each is the tested model moved in its free parameters and in the upper limit of `shape`, in all zones alike.
class OpenGrounds {
 public:
  /// @param steps       of the free parameters [z]
  /// @param scores      their directions come first, then that of the shape
  /// @param covariance  of the scores
  OpenGrounds(const TestedModel& base, const Eigen::VectorXd& steps, const CampaignScores& scores,
              const Eigen::MatrixXd& covariance, const DiagnosisRules& rules);

  /// An odd one is the mirror image of the one before: their mean is the best one.
  Model model(std::uint64_t seed, std::uint32_t number) const;

 private:
  const TestedModel& base_;
  double shape_step_;
  Eigen::VectorXd units_;             // of the moves: the steps [z], then that of the shape
  Eigen::VectorXd centre_;            // move of the best one
  Eigen::VectorXd room_;              // how far it may go from there, to either side
  Eigen::LLT<Eigen::MatrixXd> root_;  // of the precision of moves over units
};

/// Data sets without an effect.
struct NullSets {
  Eigen::MatrixXd scores;    ///< directions x sets, less the mean
  Eigen::VectorXd mean;      ///< of the scores
  Eigen::MatrixXd scatters;  ///< kinds of quantity x sets
};

/// Runs of a model: so many trials of each block, from trial number `first`.
using TrialObserver = std::function<std::vector<BlockRuns>(const Model&, std::uint32_t trials, std::uint32_t first)>;

/// Draws data sets: each of an open ground, with one trial of each block in the place of what was measured. The true
/// ground differs from the tested one. A projection removes only the linear part of what this leaves in the residual.
///
/// @param means  of the scores of each block's base trials
NullSets null_sets(const OpenGrounds& grounds, const Directions& directions, const std::vector<Eigen::VectorXd>& means,
                   const Scatters& scatters, const TrialObserver& observed, const ScoreTestOptions& options);

}  // namespace talus
