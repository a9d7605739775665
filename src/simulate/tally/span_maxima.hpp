#pragma once
#include <algorithm>

#include "talus/physics/span_speed.hpp"
#include "talus/simulate/tally/quantities.hpp"

namespace talus {

/// The motion at a share of the way along a span. `rise`: vertical speed of a flight, speed of a slide.
struct Moment {
  float share, height, rise;
};

inline Moment moment_of(const Span& span, float share) {
  return {share, height_at(span, share), rise_at(span, share)};
}

/// The largest clearance on a part of a span [m]: at an end, or at the apex if the block rises from the first end and
/// falls to the second.
inline float highest(const Span& span, const Moment& from, const Moment& to) {
  const float slope = span.height_to - span.height_from - span.bend;  // dh/ds = slope + 2 bend s
  const bool apex = slope + 2.0F * span.bend * from.share > 0.0F && slope + 2.0F * span.bend * to.share < 0.0F;
  const float top = span.height_from - 0.25F * slope * slope / span.bend;  // used only if there is an apex
  return apex ? top : std::max(from.height, to.height);
}

/// The largest square of the speed on a part of a span [m^2/s^2]: at an end.
inline float largest_speed_squared(const Span& span, const Moment& from, const Moment& to) {
  return span.plan_speed_squared + std::max(from.rise * from.rise, to.rise * to.rise);
}

/// Raises maxima to those of a part of a span.
inline void raise(Maxima& maxima, const Span& span, const Moment& from, const Moment& to) {
  maxima.raise({largest_speed_squared(span, from, to), highest(span, from, to)});
}

}  // namespace talus
