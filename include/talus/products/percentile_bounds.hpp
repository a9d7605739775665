#pragma once
#include <cstdint>

#include "talus/base/bounds.hpp"
#include "talus/base/sample.hpp"
#include "talus/simulate/tally/histogram.hpp"

namespace talus {

/// Ranks of the order statistics that bound a percentile; 0: there is none.
struct Ranks {
  std::uint64_t low = 0, high = 0;
};

/// The ranks, among n independent values, of the two-sided 95 % bounds of a percentile, whatever the distribution.
///
///   low  = the largest l with P(B <= l - 1) <= 2.5 %,   high = the smallest h with P(B >= h) <= 2.5 %
///
/// for B binomial of n trials of the share. `low` is 0 if not even the smallest value is a bound, `high` if not even
/// the largest is: of P95 it needs 72 values, of P99 368. docs/products.md, "Bounds of percentiles".
Ranks percentile_ranks(std::uint64_t n, double share);

/// The bounds of a percentile from the histogram of the values: the outer edges of the bins of the two ranks.
///
/// @param maximum  the largest value: no bound is above it
/// NaN where there is no bound.
Interval percentile_bounds(const LogHistogram& histogram, const Ranks& ranks, double maximum);

}  // namespace talus
