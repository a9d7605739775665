#pragma once
#include "talus/physics/block.hpp"

namespace talus {

/// Detects a trapped block. An anchor is set at the first contact with the ground, and set again at every contact
/// farther than `reach` from it in plan. The block is trapped if it is on the ground more than `patience` after the
/// last setting.
class Anchor {
 public:
  Anchor(double reach, double patience) : reach_(reach), patience_(patience) {}

  void set(const Motion& m) { place_ = m.position.head<2>(), time_ = m.time; }

  /// Checks a block on the ground, and sets the anchor again if needed. Returns whether the block is trapped.
  bool traps(const Motion& m) {
    if ((m.position.head<2>() - place_).squaredNorm() > reach_ * reach_) set(m);
    return m.time - time_ > patience_;
  }

  const Eigen::Vector2d& place() const { return place_; }
  double time() const { return time_; }

 private:
  double reach_, patience_;  // [m], [s]
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  double time_ = 0.0;
};

}  // namespace talus
