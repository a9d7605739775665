#pragma once
#include <Eigen/Core>
#include <span>

namespace talus {

/// Logarithms of densities of measured values, for the log score. docs/diagnosis-evidence.md, "The log score".
///
///   f(y) = (1 - e) k(y) + e b(y),   e = kBroadShare
///
/// k: normal kernels at the simulated values, of Silverman's width, at least kLeastWidth of the unit. b: Student's t of
/// three degrees of freedom with the mean and the covariance of the climatology. A measured value that no simulation
/// comes near costs at most ln(1 / e) more than it costs under b, and that grows with the logarithm of its distance.

inline constexpr double kBroadShare = 0.05;
inline constexpr double kLeastWidth = 0.01;

/// ln(f(y) unit) of a number.
///
/// @param simulated  n >= 1 values
/// @param broad      values of the climatology, at least one
/// @param unit       > 0: densities are of y / unit, so that they have no unit
double log_density(std::span<const double> simulated, std::span<const double> broad, double y, double unit);

/// ln(f(y) unit^2) of a place in plan; the kernels have the shape of the covariance of the simulated places.
double log_density(std::span<const Eigen::Vector2d> simulated, std::span<const Eigen::Vector2d> broad,
                   const Eigen::Vector2d& y, double unit);

/// ln of the probability of an event that happened, or not, in `hits` of `trials` trials: Krichevsky and Trofimov's
/// (hits + 1/2) / (trials + 1), mixed with the climatology's p.
double log_probability(double hits, double trials, double p, bool happened);

}  // namespace talus
