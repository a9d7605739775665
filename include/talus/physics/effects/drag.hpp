#pragma once
#include "talus/base/elementary.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects.hpp"

namespace talus {

/// vegetation-drag: share of the speed that is lost per second, c/m [1/s]; 0 from the top of the stand upwards.
///
/// @param clearance  height of the block above the ground [m]
/// Source: Leine et al. (2014), as in RAMMS::Rockfall; docs/effects.md, "vegetation-drag".
inline double vegetation_drag_rate(const VegetationDrag& drag, double mass, double clearance) {
  return clearance < drag.height ? drag.coefficient / mass : 0.0;
}

inline constexpr double kAirDensity = 1.2;  ///< at 15 degrees and 200 m above the sea [kg/m^3]

/// air-drag: share of the speed that is lost per metre, 1/2 rho C_d A / m [1/m], with the section A of the sphere.
/// Source: the drag equation; docs/effects.md, "air-drag".
inline double air_drag_rate(const AirDrag& drag, const Block& block) {
  return 0.5 * kAirDensity * drag.coefficient * kPi * block.radius() * block.radius() / block.mass;
}

/// Both kinds of drag at a place: dv/dt = -(linear + quadratic |v|) v.
struct DragRate {
  double linear = 0.0;     ///< [1/s]
  double quadratic = 0.0;  ///< [1/m]

  bool any() const { return linear > 0.0 || quadratic > 0.0; }
  double at(double speed) const { return linear + quadratic * speed; }  ///< [1/s]
};

/// A fall for a time t under gravity and a drag -r v, r constant: exact.
///
///   v(t) = e v - g t f1 z,  x(t) = x + t f1 v - g t^2 f2 z,   e = exp(-a), f1 = (1 - e)/a, f2 = (1 - f1)/a,  a = r t
class DampedFall {
 public:
  /// @param rate r [1/s], >= 0;  time t [s], >= 0. Exactly free fall where either is 0.
  DampedFall(double rate, double time) : damping_(rate * time), time_(time) {
    if (damping_ < 0.5) {
      f2_ = exponential_rest(-damping_);
      f1_ = 1.0 - damping_ * f2_;
    } else {
      f1_ = (1.0 - exponential(-damping_)) / damping_;
      f2_ = (1.0 - f1_) / damping_;
    }
  }

  Vec3 velocity_after(const Vec3& v) const {
    return (1.0 - damping_ * f1_) * v - Vec3(0.0, 0.0, kGravity * time_ * f1_);
  }
  /// The velocity at which a free parabola starts that ends at the same time in the same place. Never lower against a
  /// surface than v: what it adds is upwards.
  Vec3 parabola(const Vec3& v) const { return f1_ * v + Vec3(0.0, 0.0, kGravity * time_ * (0.5 - f2_)); }

 private:
  double damping_, time_, f1_ = 1.0, f2_ = 0.5;
};

}  // namespace talus
