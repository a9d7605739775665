#pragma once
#include <span>
#include <string>
#include <vector>

#include "talus/base/sample.hpp"
#include "talus/fit/campaign/observe.hpp"

namespace talus {

/// The error of a model on measured data. docs/closing-the-loop.md, "The score". A score of 0 would be a model that
/// says the very value; one that knows no more than the spread of the measurements has about 0.56.

/// Continuous ranked probability score of simulated values against a measured one, as a fair (unbiased) estimate:
///
///   mean |x_i - y| - 1/2 sum_ij |x_i - x_j| / (n (n - 1))
///
/// @param simulated  n >= 2 values, in any order and unit; sorted on return
/// @return           in the same unit; may be slightly negative. O(n log n)
/// Source: Ferro (2014), "Fair scores for ensemble forecasts".
double fair_crps(std::span<double> simulated, double measured);

/// The same of places in plan, by their distances [m]. n >= 2. O(n^2).
double fair_energy_score(std::span<const Eigen::Vector2d> simulated, const Eigen::Vector2d& measured);

/// What is compared: one quantity at one place.
struct GroupScore {
  std::string name;          ///< "stop", "mass", "crossed S1", "speed S1", "jump S1", "spin S1", "sample speed", ...
  double score;              ///< mean over its rows, as a share of the spread of the fitting rows [-]
  std::uint32_t rows;        ///< measurements that were scored: blocks
  double weight = 1.0;       ///< in the total
  std::uint32_t unseen = 0;  ///< rows of too few simulated values: they score as the climatology, not as the model
};

/// The score of one block in one group.
struct RowScore {
  std::uint32_t group;  ///< index into Score::groups
  std::uint32_t block;  ///< index into Campaign::blocks
  double score;
  bool unseen = false;  ///< see GroupScore::unseen
};

struct Score {
  double total = kNotGiven;  ///< weighted mean over the groups; NaN where there is none
  std::vector<GroupScore> groups;
  std::vector<RowScore> rows;  ///< ordered by group, then by block
};

/// Fewest simulated values with which a row is scored; below, it scores as the climatology of the fitting rows.
inline constexpr std::size_t kFewestSimulated = 10;
/// Fewest rows of a group that counts, and fewest fitting rows that give a spread.
inline constexpr std::size_t kFewestRows = 5;

/// Scores what was simulated against what was measured, exactly as INTERFACE.md says.
///
/// @param runs  by block of the campaign; those asked for must have been simulated
/// @param ask   which blocks are scored, the fitting or the held-out ones; size: blocks
///
/// Spreads, p and the climatology come from the fitting rows (holdout = false) alone, whatever `ask` is.
Score score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
            std::size_t fewest_simulated = kFewestSimulated);

/// The same with groups of n rows that count n / (n + 10): what a fit minimises. The mean of a group tells of its
/// quantity, with a variance that all groups have, and of the luck of its rows, with one that falls with n. In the
/// error all groups count alike, and five rows at a far screen would rule the search. docs/closing-the-loop.md,
/// "Objective".
Score weigh_groups(Score score);

/// The fewest simulated values for a row in a search with so many trials: a tenth of them, as ten of a hundred are.
/// With ten whatever the trials, a search with few would not see what only some of them reach.
std::size_t fewest_simulated_of(std::uint32_t trials);

/// The total of the rows of a score with weights, such as how often a bootstrap drew each block: the mean over groups
/// of the weighted mean over their rows. A group of no weight does not count.
///
/// @param weight  by block of the campaign, >= 0
double weighted_total(const Score& score, std::span<const double> weight);

/// 95 % interval of the total, and of each group, over which blocks happened to be released: percentiles of a
/// bootstrap that draws blocks with replacement, the same blocks for all groups. The model is held fixed.
struct ScoreIntervals {
  Interval total;
  std::vector<Interval> groups;  ///< as Score::groups
};
ScoreIntervals bootstrap(const Score& score, std::size_t blocks, std::uint32_t draws = 2000, std::uint64_t seed = 1);

/// By how much a model lowers the total of another, as a share of the other's, with a 95 % interval over the blocks:
/// 1 - after/before of the same bootstrap draws. Both must be scores of the same rows.
struct Reduction {
  double share = kNotGiven;
  Interval interval;
};
Reduction reduction(const Score& before, const Score& after, std::size_t blocks, std::uint32_t draws = 2000,
                    std::uint64_t seed = 1);

/// The difference of two totals of the same rows, negative where `after` is the better one, over which blocks happened
/// to be released.
struct Difference {
  double mean = 0.0;
  Interval interval;          ///< 95 %
  std::vector<double> draws;  ///< of the bootstrap
};
Difference difference(const Score& before, const Score& after, std::size_t blocks, std::uint32_t draws = 1000,
                      std::uint64_t seed = 1);

/// Number of times that each of the blocks that have a row is drawn in bootstrap number `draw`. Size: blocks.
std::vector<double> bootstrap_weights(const Score& score, std::size_t blocks, std::uint32_t draw, std::uint64_t seed);

}  // namespace talus
