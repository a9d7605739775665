#pragma once
#include "talus/simulate/tally/histogram.hpp"

namespace talus::test {

/// One percentile of a histogram.
inline double percentile(const LogHistogram& histogram, double share) {
  double value = 0.0;
  histogram.percentiles({&share, 1}, {&value, 1});
  return value;
}

}  // namespace talus::test
