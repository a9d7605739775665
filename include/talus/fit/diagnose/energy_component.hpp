#pragma once
#include "talus/fit/diagnose/residual.hpp"

namespace talus {

/// One number per block: how much more energy it had than the model gives it. The residuals that grow with energy
/// (run-out, crossings, speeds, jumps, spins, samples; not the lateral distance, nor the mass that is left) are
/// averaged with the weights of generalised least squares: a = w'z / sqrt(w'Cw), w = C^-1 diag(C), with the model's
/// own pooled covariance C of what was observed of the block. (A residual moves with the energy in proportion to its
/// variance, which is 1 but of crossings.) If the model is right a has mean 0 and variance 1; where only the run-out
/// was measured it is z of the run-out.
///
/// A weight below zero (of two residuals that are nearly the same) is set to zero: more energy never counts as less.
class EnergyComponent {
 public:
  /// @param runs  of which `space` was made; it and they must outlive this
  EnergyComponent(const ResidualSpace& space, const std::vector<BlockRuns>& runs);

  /// Of one block; NaN where none of its quantities was measured.
  double of_measured(std::size_t block) const { return of(block, space_.of_measured(block)); }
  double of(std::size_t block, const Residual& residual) const;

 private:
  using Weights = Eigen::VectorXd;
  /// Residuals that carry energy. A crossing is the normal score of its middle rank: blocks that seldom cross have rare
  /// residuals of ten and more otherwise, which would rule any mean.
  Eigen::VectorXd carriers(std::size_t block, const Residual& residual) const;
  const Weights& weights_of(const std::vector<bool>& seen) const;

  const ResidualSpace& space_;
  std::vector<std::size_t> observables_;
  Eigen::MatrixXd covariance_;
  mutable std::map<std::vector<bool>, Weights> weights_;  // by what was observed
};

}  // namespace talus
