#pragma once
#include <Eigen/Core>
#include <span>

namespace talus {

/// Fair scores of simulated values against a measured one: on average what infinitely many simulated values would
/// score, whatever their number. Source: Ferro (2014), "Fair scores for ensemble forecasts". docs/closing-the-loop.md,
/// "The score".

/// Continuous ranked probability score:
///
///   mean |x_i - y| - 1/2 sum_ij |x_i - x_j| / (n (n - 1))
///
/// @param simulated  n values, in any order and unit; sorted on return. Of a single one its distance, which is not fair
/// @return           in the same unit; may be slightly negative. O(n log n)
double fair_crps(std::span<double> simulated, double measured);

/// The same beyond a threshold t: `fair_crps` of max(x_i, t) and max(y, t), the threshold-weighted score. Values below
/// t are all alike to it. Source: Allen, Ginsbourger & Ziegel (2023), "Evaluating forecasts for high-impact events
/// using transformed kernel scores", Section 3.1; Gneiting & Ranjan (2011).
///
/// @param simulated  cut off at t and sorted on return
double fair_tail_crps(std::span<double> simulated, double measured, double threshold);

/// Energy score of simulated places in plan against a measured one: `fair_crps` with their distances [m]. O(n^2).
double fair_energy_score(std::span<const Eigen::Vector2d> simulated, const Eigen::Vector2d& measured);

/// Brier score of the share q = hits / trials of trials in which an event happened:
///
///   (q - 1{happened})^2 - q (1 - q) / (n - 1)
///
/// It is `fair_crps` of ones and zeros. Of no trials: that of q = 0.
double fair_brier_score(double hits, double trials, bool happened);

}  // namespace talus
