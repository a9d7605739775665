#pragma once
#include "talus/physics/flight.hpp"

namespace talus {

/// Formulas of a flight over one patch, for one block or several in lanes.

/// Times at which a straight line in plan crosses the successive grid lines of one direction.
template <class Number>
struct Lines {
  Number next, every;  // [s], infinite if the line is parallel to these grid lines

  /// @param share  position in the patch, 0..1
  /// @param rate   speed [patches/s]
  [[gnu::always_inline]] Lines(Number share, Number rate) {
    const MaskOf<Number> crosses = rate != 0.0;
    every = choose(crosses, 1.0 / magnitude(rate), Number(kNever));
    next = choose(crosses, larger(Number(0.0), choose(rate > 0.0, 1.0 - share, share)) * every, Number(kNever));
  }
};

/// Clearance of a block over a patch: f0 + f1 t + f2 t^2 of the time in the patch.
template <class Number>
struct Clearance {
  Number f0, f1, f2;
};

/// Course of a block over a patch.
template <class Number>
struct Course {
  Number p, q, z;         // place: in the patch, and height [m]
  Number rate_u, rate_v;  // speed [patches/s]
  Number rise;            // [m/s]
};

/// @param leaving  the block is on the surface and moves away from it, in spite of rounding
template <class Number>
[[gnu::always_inline]] inline Clearance<Number> clearance_over(const BasicPatch<Number>& patch, const Course<Number>& c,
                                                               MaskOf<Number> leaving) {
  const Number slope = patch.east * c.rate_u + patch.north * c.rate_v + patch.twist * (c.p * c.rate_v + c.q * c.rate_u);
  const Number f1 = c.rise - slope;  // NaN stays NaN
  return {choose(leaving, Number(0.0), larger(c.z - patch.height(c.p, c.q), Number(0.0))),
          choose(leaving, larger(f1, Number(0.0)), f1), -0.5 * kGravity - patch.twist * c.rate_u * c.rate_v};
}

/// Time until a block over one half of a creased patch is over the other half [s]; infinite if it never is.
template <class Number>
[[gnu::always_inline]] inline Number time_to_crease(MaskOf<Number> rising, MaskOf<Number> north,
                                                    const Course<Number>& c) {
  const Number rate = rate_across<Number>(rising, c.rate_u, c.rate_v);
  const MaskOf<Number> south = opposite(north), falls = rate<0.0, rises = rate> 0.0;
  const MaskOf<Number> meets = (north & falls) | (south & rises);
  return choose(meets, -across<Number>(rising, c.p, c.q) / rate, Number(kNever));
}

}  // namespace talus
