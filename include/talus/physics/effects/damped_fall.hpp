#pragma once
#include "talus/base/elementary.hpp"
#include "talus/base/vector.hpp"

namespace talus {

/// Flight with vegetation-drag and air-drag. docs/effects.md, "Flight with drag".

/// Rates of both kinds of drag at a place: dv/dt = -(linear + quadratic |v|) v.
struct DragRate {
  double linear = 0.0;     ///< [1/s]
  double quadratic = 0.0;  ///< [1/m]

  bool any() const { return linear > 0.0 || quadratic > 0.0; }
  double at(double speed) const { return linear + quadratic * speed; }  ///< [1/s]
};

/// Exact solution of a fall for a time t under gravity and a drag -r v, r constant.
///
///   v(t) = e v - g t f1 z,  x(t) = x + t f1 v - g t^2 f2 z,   e = exp(-a), f1 = (1 - e)/a, f2 = (1 - f1)/a,  a = r t
class DampedFall {
 public:
  /// @param rate  r [1/s], >= 0; if 0, exactly free fall
  /// @param time  t [s], >= 0
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
  /// Start velocity of the free parabola that ends at the same time in the same place: f1 v, plus an upward part. So a
  /// block that leaves the ground with v also leaves it with this velocity.
  Vec3 parabola(const Vec3& v) const { return f1_ * v + Vec3(0.0, 0.0, kGravity * time_ * (0.5 - f2_)); }

 private:
  double damping_, time_, f1_ = 1.0, f2_ = 0.5;
};

}  // namespace talus
