#pragma once
#include <Eigen/Core>
#include <vector>

namespace talus {

/// Whether a candidate, at one place, explains what a model leaves. docs/closing-the-loop.md, "The score test".
struct Verdict {
  std::vector<std::size_t> members;  ///< indices into the candidates: one, or neighbouring bands, or days
  Eigen::VectorXd estimate;          ///< of its tested parameters, one step from zero [kNoticed in z]
  Eigen::VectorXd ground;            ///< how far the base's own parameters would move along with it [z]
  double statistic = 0.0;            ///< s' V^-1 s, the larger one of V by the model and V by the blocks
  double p_value = 1.0;              ///< of this place alone
};

}  // namespace talus
