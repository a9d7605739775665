#pragma once
#include <cmath>

#include "talus/physics/path.hpp"

namespace talus {

/// a + b s + c s^2 of the share s of a span.
struct Quadratic {
  double a, b, c;
};

/// Whether a span is a piece of a slide, or a vertical fall. Its rise is then the whole speed.
inline bool is_slide(const Span& span) {
  return span.plan_speed_squared == 0.0F;
}

/// The square of the speed along a span [m^2/s^2]. In flight the vertical speed is linear in the share; in a slide of
/// constant acceleration the square of the speed is. Convex in both: largest at an end of any part.
inline Quadratic speed_squared_along(const Span& span) {
  const double from = span.rise_from, to = span.rise_to;
  if (is_slide(span)) return {from * from, to * to - from * from, 0.0};
  return {span.plan_speed_squared + from * from, 2.0 * from * (to - from), (to - from) * (to - from)};
}

/// The square of the speed at a share of the way along a span [m^2/s^2].
inline double speed_squared_at(const Span& span, double share) {
  const Quadratic f = speed_squared_along(span);
  return f.a + share * (f.b + share * f.c);
}

/// The rise at a share of the way along a span [m/s]: the vertical speed of a flight, the whole speed of a slide.
inline float rise_at(const Span& span, float share) {
  if (is_slide(span)) return static_cast<float>(std::sqrt(speed_squared_at(span, share)));
  return span.rise_from + (span.rise_to - span.rise_from) * share;
}

/// The clearance at a share of the way along a span [m].
inline float height_at(const Span& span, float share) {
  return span.height_from + share * (span.height_to - span.height_from - span.bend * (1.0F - share));
}

}  // namespace talus
