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

}  // namespace talus
