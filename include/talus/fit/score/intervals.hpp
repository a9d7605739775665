#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "talus/base/sample.hpp"
#include "talus/fit/score/score.hpp"

namespace talus {

/// 95 % intervals for the choice of the released blocks; the model is held fixed. Each leaves out one cluster of blocks
/// after another (the jackknife) and takes Student's t with as many degrees of freedom as there are clusters, less one:
///
///   estimate -+ t sqrt((G - 1) / G sum_c (estimate without c - estimate)^2)
///
/// Clusters that have no group of scores in common (two sites; a screen read in two of ten clusters, where each block
/// is taken by itself) are strata: their variances add up, with Satterthwaite's degrees of freedom. The interval of one
/// group rests on the clusters that have rows in it.
///
/// They cover in 93 to 97 of 100 cases at 24 blocks and more (docs/diagnosis-evidence.md, "Intervals").

/// By block of the campaign, the number of its cluster: blocks of one `group` are not independent. A block without
/// group is its own. The numbers follow from the names alone.
std::vector<std::uint32_t> clusters_of(const Campaign& campaign);

/// Clusters with rows in a group of scores below which nothing can be said of their scatter: its blocks are then taken
/// to be independent.
inline constexpr std::size_t kFewestClusters = 3;

/// Number of clusters that an interval of these rows rests on, and whether they are those that were given.
struct UsedClusters {
  std::size_t count = 0, blocks = 0;    ///< of clusters, and of the blocks in them
  bool given = true;                    ///< false: each block is its own
  std::vector<std::string> by_block{};  ///< groups of scores that fewer than three given clusters have rows in

  bool are_groups() const { return given && count < blocks; }
};
UsedClusters used_clusters(const Score& score, std::span<const std::uint32_t> clusters);

/// Intervals of the total and of each group.
struct ScoreIntervals {
  Interval total;
  std::vector<Interval> groups;  ///< as Score::groups
};
/// @param clusters  by block of the campaign (`clusters_of`)
ScoreIntervals score_intervals(const Score& score, std::span<const std::uint32_t> clusters);

/// Share by which one model lowers the total of another: 1 - after/before. Both must be scores of the same rows.
struct Reduction {
  double share = kNotGiven;
  Interval interval;
};
Reduction reduction(const Score& before, const Score& after, std::span<const std::uint32_t> clusters);

/// Nats per block by which one model's log score is better than another's, positive where `after` is better. Both must
/// be log scores of the same rows.
struct NatsGained {
  double per_block = kNotGiven;
  Interval interval;
};
NatsGained nats_gained(const Score& before, const Score& after, std::span<const std::uint32_t> clusters);

}  // namespace talus
