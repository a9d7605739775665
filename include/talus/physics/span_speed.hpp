#pragma once
#include "talus/physics/path.hpp"

namespace talus {

/// The square of the speed at a share of the way along a span [m^2/s^2]: in flight the vertical speed is linear in the
/// share; in a slide of constant acceleration the square of the speed is. Convex in both: largest at an end of any
/// part.
inline double speed_squared_at(const Span& span, double share) {
  const double from = span.rise_from, to = span.rise_to;
  if (span.plan_speed_squared == 0.0F) return from * from + share * (to * to - from * from);
  const double rise = from + share * (to - from);
  return span.plan_speed_squared + rise * rise;
}

}  // namespace talus
