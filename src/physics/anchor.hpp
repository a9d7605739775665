#pragma once
#include "talus/physics/block.hpp"

namespace talus {

/// Detects a block that stays at its place. An anchor is set at the first contact with the ground, and set again at
/// every contact that is farther from it than one diameter in plan, or by more than one diameter higher or lower. The
/// block stays if it is on the ground more than `patience` after the last setting. The height counts because on a steep
/// wall a block falls far within one diameter in plan. docs/physics.md, "End of a trajectory".
class Anchor {
 public:
  /// @param patience  [s]
  explicit Anchor(double patience) : patience_(patience) {}

  void set(const Motion& m) { place_ = m.position, time_ = m.time; }

  /// Checks a block on the ground, and sets the anchor again if needed. Returns whether the block stays.
  ///
  /// @param diameter  of the block now: it may have broken since the last call [m]
  bool holds(const Motion& m, double diameter) {
    const Vec3 way = m.position - place_;
    const double farthest = diameter * diameter;
    if (way.head<2>().squaredNorm() > farthest || way.z() * way.z() > farthest) set(m);
    return m.time - time_ > patience_;
  }

  const Vec3& place() const { return place_; }
  double time() const { return time_; }

 private:
  double patience_;
  Vec3 place_ = Vec3::Zero();
  double time_ = 0.0;
};

}  // namespace talus
