#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "talus/base/bounds.hpp"
#include "talus/base/expect.hpp"

namespace talus {

inline constexpr double kConfidence = 0.95, kTail = 0.025;  // of every interval that is printed; of one side of it
inline constexpr double kTwoSided = 1.959963984540054;      // the same in standard deviations of a normal law

/// A confidence interval; NaN if it cannot be computed.
struct Interval {
  double low = kNotGiven, high = kNotGiven;
};

/// Quantile of a sample: the value below which a share of it lies. Linear between order statistics (Hyndman & Fan, type
/// 7).
///
/// @param sorted  the sample, ascending, not empty
/// @param share   0..1
inline double quantile(std::span<const double> sorted, double share) {
  TALUS_EXPECT(!sorted.empty() && share >= 0.0 && share <= 1.0, "a quantile is of a sample, for a share");
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double above = sorted[std::min(below + 1, sorted.size() - 1)];
  return sorted[below] + (place - static_cast<double>(below)) * (above - sorted[below]);
}

/// Median of a sample; NaN if it is empty.
inline double median_of(std::vector<double> sample) {
  if (sample.empty()) return kNotGiven;
  std::sort(sample.begin(), sample.end());
  return quantile(sample, 0.5);
}

/// Interval that holds the middle `kConfidence` of a sample; NaN if it is empty.
inline Interval middle_of(std::vector<double> sample) {
  if (sample.empty()) return {};
  std::sort(sample.begin(), sample.end());
  return {quantile(sample, kTail), quantile(sample, 1.0 - kTail)};
}

}  // namespace talus
