#pragma once
#include <cstdint>

#include "talus/base/sample.hpp"

namespace talus {

/// Clopper-Pearson bounds of a probability from `hits` in `trials`, two-sided.
///
/// @param confidence  for instance 0.95
/// Exactly 0 at no hit and 1 at all hits. Covers at least `confidence` for independent trials of one probability, and
/// more for trials stratified by source cell (Hoeffding 1956). docs/products.md, "Bounds".
Interval probability_bounds(std::uint64_t hits, std::uint64_t trials, double confidence);

/// 95 % bounds of the mean probability of those source cells that hit at least once.
///
/// @param hits     of these source cells together
/// @param sources  number of these source cells, >= 1
/// @param trials   of each source cell
/// The source cells are chosen by their hits, so that the hits are too many. Given one hit, the further hits of a
/// source cell are no more than those of `trials - 1` free trials, and all its hits no fewer than those of `trials`:
/// the lower bound is that of (hits - sources) in sources (trials - 1), the upper bound that of hits in sources trials.
Interval bounds_of_reached(std::uint64_t hits, std::uint64_t sources, std::uint64_t trials);

}  // namespace talus
