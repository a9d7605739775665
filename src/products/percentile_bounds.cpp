#include "talus/products/percentile_bounds.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "talus/base/expect.hpp"

namespace talus {
namespace {

/// P(B <= k) for B binomial of n trials of probability p.
double at_most(double k, double n, double p) {
  if (k < 0.0) return 0.0;
  return k >= n ? 1.0 : boost::math::ibetac(k + 1.0, n - k, p);
}

/// P(B >= k).
double at_least(double k, double n, double p) {
  if (k <= 0.0) return 1.0;
  return k > n ? 0.0 : boost::math::ibeta(k, n - k + 1.0, p);
}

}  // namespace

Ranks percentile_ranks(std::uint64_t n, double share) {
  TALUS_EXPECT(share > 0.0 && share < 1.0, "a percentile lies inside of the distribution");
  const auto count = static_cast<double>(n);
  const double mean = count * share, width = kTwoSided * std::sqrt(mean * (1.0 - share));
  double low = std::clamp(std::floor(mean - width), 0.0, count);  // near the ranks; the next steps find them exactly
  while (low > 0.0 && at_most(low - 1.0, count, share) > kTail) --low;
  while (low < count && at_most(low, count, share) <= kTail) ++low;
  double high = std::clamp(std::ceil(mean + width), 1.0, count + 1.0);
  while (high <= count && at_least(high, count, share) > kTail) ++high;
  while (high > 1.0 && at_least(high - 1.0, count, share) <= kTail) --high;
  return {static_cast<std::uint64_t>(low), high > count ? 0 : static_cast<std::uint64_t>(high)};
}

Interval percentile_bounds(const LogHistogram& histogram, const Ranks& ranks, double maximum) {
  Interval bounds{kNotGiven, kNotGiven};
  if (ranks.low > 0) {
    const LogHistogram::Bin bin = histogram.bin_of(static_cast<double>(ranks.low));
    bounds.low = bin.lowest ? 0.0 : bin.low;
  }
  if (ranks.high > 0) bounds.high = std::min(maximum, histogram.bin_of(static_cast<double>(ranks.high)).high);
  return bounds;
}

}  // namespace talus
