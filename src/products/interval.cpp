#include "talus/products/interval.hpp"

#include <boost/math/special_functions/beta.hpp>

#include "in_double.hpp"
#include "talus/base/expect.hpp"

namespace talus {

Interval probability_bounds(std::uint64_t hits, std::uint64_t trials, double confidence) {
  TALUS_EXPECT(hits <= trials, "no more hits than trials");
  const double tail = 0.5 * (1.0 - confidence);
  const double k = static_cast<double>(hits), n = static_cast<double>(trials);
  return {hits == 0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1.0, tail, InDouble()),
          hits == trials ? 1.0 : boost::math::ibeta_inv(k + 1.0, n - k, 1.0 - tail, InDouble())};
}

Interval bounds_of_reached(std::uint64_t hits, std::uint64_t sources, std::uint64_t trials) {
  TALUS_EXPECT(sources >= 1 && sources <= hits, "each source cell that reaches a place hits it");
  const double low =
      hits == sources ? 0.0 : probability_bounds(hits - sources, sources * (trials - 1), kConfidence).low;
  return {low, probability_bounds(hits, sources * trials, kConfidence).high};
}

}  // namespace talus
