#pragma once
#include <array>
#include <string>
#include <vector>

#include "talus/base/sample.hpp"
#include "talus/fit/campaign/observe.hpp"

namespace talus {

/// Where measured values lie among the simulated ones: whether a model scatters as much as the blocks do.
/// docs/closing-the-loop.md, "Calibration of the spread".

/// Shares of the simulated values below which measured ones are counted.
inline constexpr std::array<double, 3> kCoverageShares{0.05, 0.5, 0.95};
/// Classes of the histogram of ranks.
inline constexpr std::size_t kRankClasses = 10;
/// p-value, corrected, below which a share is not what a right model gives.
inline constexpr double kWrongSpread = 0.01;

/// Counts of one share.
struct ShareBelow {
  std::uint32_t count = 0;  ///< measured values below that quantile of the simulated ones
  Interval expected;        ///< of the counts of a right model, the middle 95 %
  double p_value = 1.0;     ///< two-sided, exact binomial
  double corrected = 1.0;   ///< for all shares of all observables (Holm)
};

/// Calibration of one observable.
struct Coverage {
  std::string observable;    ///< "runout", "speed S1", ...
  std::uint32_t rows = 0;    ///< blocks whose measured value has a rank
  std::uint32_t unseen = 0;  ///< blocks with too few simulated values for a rank
  std::array<ShareBelow, kCoverageShares.size()> below;
  std::array<std::uint32_t, kRankClasses> ranks{};  ///< blocks by rank, in classes of equal width
  Interval expected_in_class;                       ///< of a right model, the middle 95 %

  double share(std::size_t i) const { return static_cast<double>(below[i].count) / rows; }
};

/// Rank of a measured value among simulated ones, in (0, 1):
///
///   (b + u (e + 1)) / (n + 1)        b of the n values below the measured one, e equal to it, u random
///
/// If the measured value comes from the same distribution as the simulated ones, the rank is uniform for any n, ties
/// included: the value is equally likely to have each of the n + 1 places.
///
/// @param draw  u, in (0, 1)
double random_rank(std::span<const double> simulated, double measured, double draw);

/// The calibration of the run-out (plan distance from the release to the stop), and of speed, jump and spin at the
/// first crossing of each screen, of the asked blocks. If all of them came to rest, a trial that left the terrain
/// counts as a run-out beyond the measured one; else, and of mapped blocks, it is left out, as blocks that left are
/// missing among the measured: `leaving_test` counts these trials. Left out: observables with fewer than five ranks; a
/// block with fewer than ten simulated values.
///
/// @param runs  by block of the campaign; those asked for must have been simulated
std::vector<Coverage> coverage(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask);

/// Whether blocks leave the terrain more often, or more seldom, in the model than they did.
struct LeavingTest {
  std::size_t blocks = 0;      ///< asked ones
  std::size_t missing = 0;     ///< those that were not measured at rest: at most so many left
  double expected = 0.0;       ///< number of blocks that leave by the model: the sum of the shares of their trials
  double p_value = kNotGiven;  ///< that so few leave; NaN: fewer than five blocks, or mapped ones
  double p_if_all_left = kNotGiven;  ///< that so many leave; counts only if all missing ones left
};

/// P-values: the probability that at most, and at least, M of the blocks leave, M of which have no measured place of
/// rest, where block b leaves with probability
///
///   (k_b + m_b) / (n_b + 1)        k_b of its n_b trials left; m_b = 1 if it has no measured place of rest, else 0
///
/// If all missing blocks have left, that is exact for any n_b: given n_b + 1 trajectories of a block, the measured one
/// is equally likely to be each of them. A missing block that came to rest unseen makes `p_value` too large, never
/// too small, and `p_if_all_left` too small.
LeavingTest leaving_test(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask);

}  // namespace talus
