#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "talus/fit/diagnose/residual.hpp"
#include "talus/fit/diagnose/score_test.hpp"

namespace talus {

/// Scores of a campaign by all directions, each less the mean of its block's base trials.
struct CampaignScores {
  std::vector<Eigen::MatrixXd> trials;  ///< by block: those of its base trials, one column each
  std::vector<Eigen::VectorXd> means;   ///< by block
  Eigen::VectorXd measured;             ///< of the measurements, summed over the blocks
};

/// Signatures of all directions in which the model could move: how each changes the residuals of the blocks.
class Directions {
 public:
  /// @param unmoved  the base again, with the random numbers of the runs that will be added: their noise is the same in
  /// both
  Directions(const Campaign& campaign, const ResidualSpace& space, const std::vector<BlockRuns>& base,
             const std::vector<BlockRuns>& unmoved, const std::vector<bool>& rows);

  void add(const std::vector<BlockRuns>& moved);

  /// Adds a direction for each free parameter of the model that is tested. @return by how much each was moved [z]
  Eigen::VectorXd add_free(const TestedModel& base, const Observer& observed, const DiagnosisRules& rules);

  Eigen::Index size() const { return std::ssize(signatures_); }
  const std::vector<std::size_t>& blocks() const { return blocks_; }
  std::span<const std::uint32_t> streams() const { return streams_; }

  /// Residuals of what was measured: components x blocks.
  Eigen::MatrixXd measured() const;
  /// By block: residuals of trials of a moved base, as if they had been measured; components x trials.
  std::vector<Eigen::MatrixXd> trials_of(const std::vector<BlockRuns>& moved) const;

  CampaignScores scores() const;
  /// The scores of trials of block number i: directions x trials.
  Eigen::MatrixXd scores_of(std::size_t i, const Eigen::MatrixXd& trials) const;

 private:
  const ResidualSpace& space_;
  const std::vector<BlockRuns>& base_;
  std::vector<std::size_t> blocks_;
  std::vector<std::uint32_t> streams_;  // of the blocks
  Eigen::MatrixXd smoother_;
  std::vector<Eigen::VectorXd> rest_;        // by block: mean residual of the base itself, which is noise
  std::vector<Eigen::MatrixXd> signatures_;  // by direction: blocks x components
};

/// Variance of the scores of one data set under the model, directions x directions.
Eigen::MatrixXd covariance_of(const std::vector<Eigen::MatrixXd>& trials);

/// Precision of a step of the base by its prior.
inline double step_prior(const DiagnosisRules& rules) {
  return rules.base_step * rules.base_step / (rules.base_sd * rules.base_sd);
}

}  // namespace talus
