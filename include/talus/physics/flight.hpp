#pragma once
#include <cmath>
#include <limits>

#include "talus/physics/path.hpp"
#include "talus/terrain/surface.hpp"

namespace talus {

inline constexpr double kNever = std::numeric_limits<double>::infinity();  // time or distance of what never happens

/// How a flight ended.
enum class FlightEnd {
  Landed,  ///< on the surface, in patch `at`
  Left,    ///< beyond the edge of the terrain or above missing data
  Caught,  ///< in a barrier
  Aloft    ///< still in the air: the longest time or the time limit was reached
};

/// Time of the first contact of a block with the ground. Its clearance over a patch is f0 + f1 t + f2 t^2.
///
/// @param f0     clearance now [m], >= 0
/// @param f1     its rate [m/s]
/// @param f2     half its acceleration [m/s^2]
/// @param until  end of the time in the patch [s], may be infinite
/// @return       time in [0, until] [s]; infinity if there is no contact
///
/// Closed form: the smallest root at which the clearance falls. Error: 4 eps relative where f2 <= 0; more where a path
/// grazes ground that rises to meet it. NaN gives infinity.
template <class Number>
[[gnu::always_inline]] inline Number first_contact(Number f0, Number f1, Number f2, Number until) {
  const Number last = f0 + until * (f1 + until * f2);
  const MaskOf<Number> concave = f2 <= 0.0;
  const MaskOf<Number> above = concave & (last > 0.0);  // concave: lowest at the ends
  if (all(above)) return kNever;
  const Number discriminant = f1 * f1 - 4.0 * f2 * f0;
  const MaskOf<Number> meets = opposite(above) & (discriminant >= 0.0);
  if (!any(meets)) return kNever;
  const Number speed = root(discriminant);
  const MaskOf<Number> falls = f1 < 0.0;
  const Number quotient = choose(falls, 2.0 * f0, f1 + speed) / choose(falls, speed - f1, -2.0 * f2);
  const Number contact = choose(falls | (f2 < 0.0), quotient, Number(kNever));
  // Below the ground at the end: rounding put the contact later.
  const Number late = choose(concave & (last < 0.0), until, Number(kNever));
  return choose(meets, choose(contact <= until, contact, late), Number(kNever));
}
inline double first_contact(double f0, double f1, double f2, double until) {
  return first_contact<double>(f0, f1, f2, until);
}

/// Length of a parabola in space [m], by three Gauss points on the speed (exact for polynomials up to degree 5).
///
/// @param v         velocity at its start [m/s]
/// @param duration  [s]
template <class Number>
[[gnu::always_inline]] inline Number arc_length(const VectorOf<Number>& v, Number duration) {
  constexpr double kNode = 0.7745966692414834;  // sqrt(3/5)
  const Number plan2 = v.x() * v.x() + v.y() * v.y();
  const auto speed = [&](double share) {
    const Number rise = v.z() - kGravity * duration * share;
    return root(plan2 + rise * rise);
  };
  return duration / 18.0 * (5.0 * speed(0.5 - 0.5 * kNode) + 8.0 * speed(0.5) + 5.0 * speed(0.5 + 0.5 * kNode));
}
double arc_length(const Vec3& v, double duration);

/// Follows a free parabola patch by patch until it meets the ground, by one quadratic per patch (two if it crosses
/// a crease of the patch).
///
/// @param motion     state at the start; on return at the end: landed (exactly on the surface) or left
/// @param at         patch of the start; on return: of the end
/// @param grounded   the block starts on the surface of `at` and moves away from it
/// @param path       gets one `Span` per patch crossed, two where it crosses a crease
///
/// Exact except for rounding; no time step. At most 2 (columns + rows) + 5 pieces. docs/physics.md, "Flight".
FlightEnd fly(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path);

/// A piece of a flight, as above: ends `Aloft` after `longest` [s], >= 0, unless it landed or left before.
FlightEnd fly(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path, double longest);

}  // namespace talus
