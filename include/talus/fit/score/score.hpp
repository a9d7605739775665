#pragma once
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "talus/base/expect.hpp"
#include "talus/base/sample.hpp"
#include "talus/fit/campaign/observe.hpp"

namespace talus {

/// The error of a model on measured data. docs/closing-the-loop.md, "The score". A model that gives the measured value
/// exactly scores 0; one that knows only the spread of the measurements scores about 0.56 (in groups of
/// `crossed`: 1).

/// The score of one group: one quantity at one place.
struct GroupScore {
  std::string name;          ///< "stop", "mass", "crossed S1", "speed S1", "jump S1", "spin S1", "sample speed", ...
  double score;              ///< mean over its rows, as a share of the spread of the fitting rows [-]
  std::uint32_t rows;        ///< measurements that were scored: blocks
  double weight = 1.0;       ///< in the total
  std::uint32_t unseen = 0;  ///< rows with too few simulated values: scored by the climatology, not by the model
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
  double cut_short = 0.0;      ///< share of the trials that did not end in a search [-]
};

/// Weighted mean over groups of `value(g)`, a number of each; groups of NaN do not count. NaN where none counts.
template <class Value>
double mean_over(std::span<const GroupScore> groups, const Value& value) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (const double v = value(g); !std::isnan(v)) sum += groups[g].weight * v, weights += groups[g].weight;
  return weights > 0.0 ? sum / weights : kNotGiven;
}
/// Their weighted mean score, of which none is NaN.
inline double mean_over(std::span<const GroupScore> groups) {
  return mean_over(groups, [groups](std::size_t g) {
    TALUS_EXPECT(!std::isnan(groups[g].score), "a group has rows, and each a score");
    return groups[g].score;
  });
}

/// Fewest simulated values with which a row is scored; below, it scores as the climatology of the fitting rows.
inline constexpr std::size_t kFewestSimulated = 10;
/// Fewest rows of a group that counts, and fewest fitting rows that give a spread.
inline constexpr std::size_t kFewestRows = 5;

/// Rise of the score of a row if all trials of its block were cut short; of some, their share of it. A model that
/// climatology beats by far is still better than one whose blocks do not come to an end. docs/diagnosis-time.md.
inline constexpr double kCutShort = 4.0;
/// Rise of the score of a measured place of rest, in a fit, if all trials of its block leave the terrain.
inline constexpr double kGone = 4.0;

/// The rule that turns a measurement and its simulated values into a score.
enum class ScoreRule {
  Fair,        ///< CRPS, energy score and Brier score over the spread of the fitting rows
  LogDensity,  ///< minus the logarithm of the density of the measured value [nats]. docs/diagnosis-evidence.md
};

struct ScoreOptions {
  ScoreRule rule = ScoreRule::Fair;
  std::size_t fewest_simulated = kFewestSimulated;
  /// By block: blocks of one number were left out together of a cross-validation, and none of them enters the
  /// climatology of another. Empty: each block is left out of its own climatology alone.
  std::vector<std::uint32_t> folds;
  /// A row with too few simulated values scores as all fitting rows, itself among them, as in score.py. Not so in what
  /// a fit minimises: a block's own value makes the climatology better than a right model, and a fit would do well to
  /// keep the blocks from a screen where few were measured.
  bool own_value_too = true;
  /// The row of a place of rest rises if most trials of its block leave the terrain: by kGone if all do, by nothing if
  /// half do. Not so in score.py. Without it a fit would do well to send the blocks off the map: a row without
  /// simulated stops scores as the climatology. So rises the row of the place of a mapped block.
  bool leaving_costs = false;
  /// The climatology knows where a block was released, as a model does: its places of rest are the ways of the others
  /// from their releases, begun at its own.
  bool ways_from_release = false;
};

/// How the rows are scored that a fit minimises, and that decide between fits.
inline ScoreOptions fit_scoring(std::size_t fewest_simulated = kFewestSimulated) {
  return {ScoreRule::Fair, fewest_simulated, {}, false, true};
}

/// Scores the simulations of the asked blocks against their measurements, as defined in docs/closing-the-loop.md, "The
/// score".
///
/// @param runs  by block of the campaign; those asked for must have been simulated. Empty: the climatology is scored
/// @param ask   which blocks are scored, the fitting or the held-out ones; size: blocks
///
/// Spreads, p and the climatology come from the fitting rows (holdout = false) alone, whatever `ask` is. The total by
/// log density is the sum of a block's rows, on average over the blocks.
Score score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
            const ScoreOptions& options);
Score score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
            std::size_t fewest_simulated = kFewestSimulated);

/// The score of the climatology on the same rows: of each block the measurements of the other fitting rows stand in for
/// simulated values. A model without skill does no better.
Score score_of_climatology(const Campaign& campaign, const std::vector<bool>& ask, const ScoreOptions& options = {});

/// Rows from which on a group counts in a headline: of fewer, one block may rule the total.
inline constexpr std::uint32_t kHeadlineRows = 10;

/// The score without its groups of fewer rows.
Score of_large_groups(const Score& score, std::uint32_t fewest = kHeadlineRows);

/// The score that a fit minimises: a group of n rows has the weight n / (n + 10). The variance of a group's mean has
/// two parts: one from its quantity, alike for all groups, and one from the choice of its rows, which falls with n. In
/// the reported error all groups count alike; in a search, five rows at a far screen would then decide.
/// docs/closing-the-loop.md, "Objective".
Score weigh_groups(Score score);

/// Fewest simulated values with which a search of so many trials scores a row: a tenth of the trials, at most
/// kFewestSimulated. With a fixed ten, a search with few trials would not score a row that only some of them reach.
std::size_t fewest_simulated_of(std::uint32_t trials);

}  // namespace talus
