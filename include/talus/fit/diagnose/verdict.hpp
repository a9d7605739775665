#pragma once
#include <Eigen/Core>
#include <vector>

namespace talus {

/// Result of the score test for a candidate at one place. docs/diagnosis-method.md, "The score test".
struct Verdict {
  std::vector<std::size_t> members;  ///< indices into the candidates: one, or neighbouring bands, or days
  Eigen::VectorXd estimate;          ///< of its tested parameters, in units of what one would notice
  Eigen::VectorXd ground;            ///< change of the base's own parameters that goes with it [z]
  double statistic = 0.0;            ///< s' V^-1 s of the best estimate within its bounds, V by the model
  double p_value = 1.0;              ///< of this place alone
};

}  // namespace talus
