#include "talus/fit/score/fair_scores.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// Mean distance to the measured value, less the mean distance of two simulated ones over 2.
double fair(double distances, double pairs, double n) {
  return distances / n - (n > 1.0 ? pairs / (n * (n - 1.0)) : 0.0);
}

}  // namespace

double fair_crps(std::span<double> simulated, double measured) {
  std::sort(simulated.begin(), simulated.end());
  const auto n = static_cast<double>(simulated.size());
  double distance = 0.0, pairs = 0.0;  // pairs: sum over i < j of x_j - x_i, by the rank of each value
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    distance += std::abs(simulated[i] - measured);
    pairs += (2.0 * static_cast<double>(i) - (n - 1.0)) * simulated[i];
  }
  return fair(distance, pairs, n);
}

double fair_tail_crps(std::span<double> simulated, double measured, double threshold) {
  for (double& value : simulated) value = std::max(value, threshold);
  return fair_crps(simulated, std::max(measured, threshold));
}

double fair_energy_score(std::span<const Eigen::Vector2d> simulated, const Eigen::Vector2d& measured) {
  double distance = 0.0, pairs = 0.0;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    distance += (simulated[i] - measured).norm();
    for (std::size_t j = 0; j < i; ++j) pairs += (simulated[i] - simulated[j]).norm();
  }
  return fair(distance, pairs, static_cast<double>(simulated.size()));
}

double fair_brier_score(double hits, double trials, bool happened) {
  const double share = hits / std::max(1.0, trials), miss = share - (happened ? 1.0 : 0.0);
  return miss * miss - share * (1.0 - share) / std::max(1.0, trials - 1.0);
}

}  // namespace talus
