#pragma once
#include <functional>
#include <span>
#include <vector>

#include "talus/products/barrier_design.hpp"

namespace talus {

/// How often some of the crossings of a line come [1/year].
using CrossingRate = std::function<Bounded(const CrossingSums&)>;

/// The values that blocks reach at a line once in some years: the largest value such that it and all larger ones
/// together come so often, and the same by the bounds of their frequency. A block that broke counts once, with the
/// largest value of its pieces. docs/barrier.md, "By return period".
///
/// 0 where crossings are rarer than that. The upper bound is infinite where even the bound for no crossing is more
/// frequent: more trajectories are needed.
///
/// @param crossings  any order;  value_of: of a crossing, in its unit;  years: above 0
/// @return           one for each of `years`
std::vector<Bounded> values_once_in(std::span<const double> years, std::span<const LineCrossing> crossings,
                                    const std::function<double(const LineCrossing&)>& value_of,
                                    const CrossingRate& rate);

}  // namespace talus
