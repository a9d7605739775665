#pragma once
#include "talus/fit/score/score.hpp"

namespace talus {

/// The score of blocks that were mapped where they lie. Groups: one per class of size, the fair energy score of the
/// place of each block against the simulated stops of blocks like it in the mapped region; and "run-out angle", the
/// fair CRPS of `RunOut::angle`. docs/mapped-deposits.md, "The score".
///
/// @param runs  empty: blocks that lie anywhere in the region stand in for simulated ones, which is what scores without
///              any knowledge. They stand in for too few simulated stops, too, so that no model gains by leaving the
///              mapped region. A model that sends most blocks off the DEM could gain all the same, by those that stay:
///              see ScoreOptions::leaving_costs
/// @param options  the rule and the folds are not used
///
/// `score` and `score_of_climatology` call it for a campaign with deposits.
Score deposit_score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                    const ScoreOptions& options);

/// Spread of the angles below which they are not scored [rad]: on a plane below its sources all angles are alike.
inline constexpr double kLeastAngleSpread = 0.0087;  // half a degree

/// Distance between the mapped and the simulated pattern of one class of size.
struct PatternDistance {
  std::string group;
  std::uint32_t blocks = 0;      ///< with enough simulated stops in the mapped region
  double distance = kNotGiven;   ///< energy distance [m], fair: 0 on average if the model is right; may be negative
  double share = kNotGiven;      ///< of twice the mean distance between mapped and simulated places, at most 1
  double p_value = kNotGiven;    ///< share of patterns of exchanged places that are at least as far apart
  double corrected = kNotGiven;  ///< for the number of classes (Holm)
};

/// Checks of a model against mapped blocks, beside the score: the pattern of each class and the share that counts.
struct DepositCheck {
  std::vector<PatternDistance> patterns;  ///< by class
  double mapped = kNotGiven;              ///< share of the simulated trajectories that end in any mapped region
  double inside = kNotGiven;              ///< share of them that end in that of their block, and count
  bool whole_dem = false;                 ///< whether all of the DEM counts as mapped
  bool strips = false;                    ///< whether some strips are held out
};

/// The fair energy distance of the patterns, class by class: with the blocks i != k of a class and their trials t
///
///   2 mean |y_i - x_kt| - mean |x_it - x_kt| - mean |y_i - y_k|
///
/// each a mean over the pairs i, k of the mean over t. Own trials are left out, and both patterns have the same sizes,
/// so that it is 0 on average for the right model at any number of blocks and trials. The p-value is an exact rank
/// among 99 patterns (from five tested classes on among 25 per class, less one), for which a random one of the places
/// of each block, mapped or simulated, stands for its place on the map. Source: Szekely & Rizzo (2013), "Energy
/// statistics: a class of statistics based on distances".
DepositCheck check_deposits(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask);

/// The distance of two patterns of n blocks, as above.
///
/// @param mapped     the place of each block
/// @param simulated  by block, at least one place each. Of two blocks the first places are compared, the second, ...
/// @return           distance and share alone
PatternDistance pattern_distance(std::span<const Eigen::Vector2d> mapped,
                                 std::span<const std::vector<Eigen::Vector2d>> simulated);

}  // namespace talus
