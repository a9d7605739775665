#pragma once
#include <string>

#include "talus/products/screen_summary.hpp"
#include "talus/simulate/totals.hpp"

namespace talus::io {

/// The text of `screens_summary.csv`: a row per screen and quantity, six digits.
///
///   screen,quantity,unit,crossings,blocks,share_of_released,mean,p50,p95,p99,maximum
std::string screens_summary_csv(const Scenario& scenario, const ScreenSummary& summary);

/// The text of `barriers.csv`: a row per barrier and part of kBarrierPart metres of its line.
///
///   barrier,from_m,to_m,hits,caught,over,broken
std::string barriers_csv(const Scenario& scenario, const Totals& totals);

}  // namespace talus::io
