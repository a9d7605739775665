#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "span_maxima.hpp"

namespace talus {

/// The clearance along a span [m].
inline Quadratic height_along(const Span& span) {
  const double bend = span.bend;
  return {span.height_from, double{span.height_to} - span.height_from - bend, bend};
}

/// Appends the shares strictly between two others at which a quadratic is 0.
inline void append_roots(const Quadratic& f, double from, double to, std::array<double, 6>& cuts, std::size_t& count) {
  const double discriminant = f.b * f.b - 4.0 * f.a * f.c;
  if (!(discriminant >= 0.0)) return;
  const double q = -0.5 * (f.b + std::copysign(std::sqrt(discriminant), f.b));  // no difference of near numbers
  for (const double root : {q / f.c, f.a / q})
    if (root > from && root < to) cuts[count++] = root;  // also leaves out infinity and NaN
}

/// The total share between `from` and `to` on which each of at most two quadratics is above 0. A closed form: the
/// quadratics change sign at their roots only.
inline double share_above(std::span<const Quadratic> all, double from, double to) {
  std::array<double, 6> cuts{from, to};
  std::size_t count = 2;
  for (const Quadratic& f : all) append_roots(f, from, to, cuts, count);
  std::sort(cuts.begin(), cuts.begin() + static_cast<std::ptrdiff_t>(count));
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double s = 0.5 * (cuts[i] + cuts[i + 1]);
    const auto above = [s](const Quadratic& f) { return f.a + s * (f.b + s * f.c) > 0.0; };
    if (std::all_of(all.begin(), all.end(), above)) sum += cuts[i + 1] - cuts[i];
  }
  return sum;
}

/// Smallest and largest square of the speed on a part of a span [m^2/s^2].
struct SpeedRange {
  float low, high;
};

inline SpeedRange speed_range(const Span& span, const Moment& from, const Moment& to) {
  if (is_slide(span)) {
    const float first = span.rise_from * span.rise_from, change = span.rise_to * span.rise_to - first;
    const float a = first + from.share * change, b = first + to.share * change;
    return {std::min(a, b), std::max(a, b)};
  }
  const float a = from.rise * from.rise, b = to.rise * to.rise;
  const bool apex = from.rise > 0.0F && to.rise < 0.0F;
  return {span.plan_speed_squared + (apex ? 0.0F : std::min(a, b)), span.plan_speed_squared + std::max(a, b)};
}

/// The share of a span, between two moments, on which the square of the speed is above a limit that it crosses there.
/// In flight it is below the limit while the vertical speed lies between -r and r.
inline float share_faster(const Span& span, float limit, const Moment& from, const Moment& to) {
  const float share = to.share - from.share;
  if (is_slide(span)) {
    const SpeedRange speed = speed_range(span, from, to);
    return share * (speed.high - limit) / (speed.high - speed.low);
  }
  const float r = std::sqrt(std::max(0.0F, limit - span.plan_speed_squared));
  const float high = std::max(from.rise, to.rise), low = std::min(from.rise, to.rise);
  const float slow = std::max(0.0F, std::min(high, r) - std::max(low, -r));
  return high > low ? share * (1.0F - slow / (high - low)) : share;
}

}  // namespace talus
