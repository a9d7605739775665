#pragma once
#include "talus/base/lane.hpp"
#include "talus/physics/block.hpp"

namespace talus {

/// Longest time that a block may stay at its place [s]: `trap_time`, and sqrt(D / 2 m) times as long where D is above
/// 2 m. From rest, the time to get one diameter away grows as sqrt(D): else large blocks would stop while they speed
/// up.
///
/// @param diameter  D [m]
template <class Number>
[[gnu::always_inline]] inline Number longest_stay(double trap_time, Number diameter) {
  constexpr double kLarge = 2.0;  // [m]
  return trap_time * root(larger(Number(1.0), diameter * (1.0 / kLarge)));
}

/// Detects a block that stays at its place. An anchor is set at the first contact with the ground, and set again at
/// every contact that is farther from it than one diameter in plan, or by more than one diameter higher or lower. The
/// block stays if it is on the ground more than `longest_stay` after the last setting. The height counts because on a
/// steep wall a block falls far within one diameter in plan. docs/physics.md, "End of a trajectory".
class Anchor {
 public:
  /// @param trap_time  [s]
  explicit Anchor(double trap_time) : trap_time_(trap_time) {}

  void set(const Motion& m) { place_ = m.position, time_ = m.time; }

  /// Checks a block on the ground, and sets the anchor again if needed. Returns whether the block stays.
  ///
  /// @param diameter  of the block now: it may have broken since the last call [m]
  bool holds(const Motion& m, double diameter) {
    const Vec3 way = m.position - place_;
    const double farthest = diameter * diameter;
    if (way.head<2>().squaredNorm() > farthest || way.z() * way.z() > farthest) set(m);
    return m.time - time_ > longest_stay(trap_time_, diameter);
  }

  const Vec3& place() const { return place_; }
  double time() const { return time_; }

 private:
  double trap_time_;
  Vec3 place_ = Vec3::Zero();
  double time_ = 0.0;
};

}  // namespace talus
