#pragma once
#include <span>
#include <string>

#include "talus/base/sample.hpp"
#include "talus/fit/score/score.hpp"

namespace talus {

/// The total of the rows of a score with weights, such as how often a bootstrap drew each block: the mean over groups
/// of the weighted mean over their rows. A group of no weight does not count.
///
/// @param weight  by block of the campaign, >= 0
double weighted_total(const Score& score, std::span<const double> weight);

/// Weights of the blocks in bootstrap number `draw`: standard exponential numbers (the Bayesian bootstrap, Rubin 1981).
/// The weight of a block depends on its stream alone, so that a block more or less, or another order, changes no other
/// weight. The variance of a mean of n values is that of the values over n + 1; drawing with replacement gives n.
/// Counts would do as well, but at small n they leave groups without any block.
///
/// @param streams  of the blocks (`bootstrap_streams`); blocks of one stream have one weight. The result has their size
std::vector<double> bootstrap_weights(std::span<const std::uint32_t> streams, std::uint32_t draw, std::uint64_t seed);

/// Streams for `bootstrap_weights` of the blocks of a campaign: those of one `group` are drawn together, as they are
/// not independent, where the fitting rows have six groups or more; else, and without groups, each block by itself.
///
/// @param site  name of the campaign among several: groups of one name at two sites are two
std::vector<std::uint32_t> bootstrap_streams(const Campaign& campaign, const std::string& site = {});

/// Difference of two totals of the same rows, negative where `after` is better; the draws vary the released blocks.
struct Difference {
  double mean = 0.0;
  Interval interval;          ///< 95 %
  std::vector<double> draws;  ///< of the bootstrap
};
Difference difference(const Score& before, const Score& after, std::span<const std::uint32_t> streams,
                      std::uint32_t draws = 1000);

/// The mean of the differences of pairs of scores of the same rows, such as those of several cross-validations; the
/// draws take the same blocks of every pair.
///
/// @param before, after  one size, at least 1
Difference mean_difference(std::span<const Score> before, std::span<const Score> after,
                           std::span<const std::uint32_t> streams);

}  // namespace talus
