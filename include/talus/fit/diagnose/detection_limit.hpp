#pragma once
#include <string>

#include "talus/base/bounds.hpp"

namespace talus {

/// The amount of an effect that a campaign would show: `DiagnosisRules::shown` standard errors of its estimate, with
/// the ground free to move along. It follows from the simulated scatter, not from what was measured.
/// docs/detection-limits.md.
struct DetectionLimit {
  std::string effect = {};
  std::string where = {};                  ///< the place where it would be seen best
  std::string key = {}, unit = {};         ///< of the parameter
  double off = 0.0;                        ///< value of the parameter without the effect
  double amount = kNotGiven;               ///< value that would be seen; NaN: none within the bounds of the parameter
  double with_further_speeds = kNotGiven;  ///< the same, if speeds were measured at further screens
};

}  // namespace talus
