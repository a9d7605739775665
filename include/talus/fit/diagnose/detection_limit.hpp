#pragma once
#include <string>
#include <vector>

#include "talus/base/bounds.hpp"

namespace talus {

/// The amount of an effect that a campaign would show: `DiagnosisRules::shown` standard errors of its estimate, with
/// the ground free to move along. It follows from the simulated scatter, not from what was measured.
/// docs/detection-limits.md.
struct DetectionLimit {
  struct Place {
    std::string where;
    double amount = kNotGiven;  ///< as below, where the effect acts there alone
  };

  std::string effect = {};
  std::string where = {};           ///< the place where it would be seen best; empty: nothing measured could show it
  std::string key = {}, unit = {};  ///< of the parameter; empty, too, where nothing measured could show the effect
  double off = 0.0;                 ///< value of the parameter without the effect; NaN: no parameter
  double amount = kNotGiven;        ///< value that would be seen; NaN: none within the bounds, or it could not be named
  double with_further_speeds = kNotGiven;  ///< the same, if speeds were measured at further screens
  std::vector<Place> places = {};          ///< all places at which it was sought, of the same parameter
};

}  // namespace talus
