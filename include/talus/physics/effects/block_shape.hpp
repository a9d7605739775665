#pragma once
#include "talus/base/elementary.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/impact.hpp"

namespace talus {

/// Blocks that are no spheres: an index i of their axes, L1/L3 - 1 unless elongation says otherwise, widens the lateral
/// scatter and takes tangential speed.
struct BlockShape {
  double lateral = 0.0;     ///< psi_scale is multiplied by 1 + lateral (L1/L3 - 1) [-]
  double loss = 0.0;        ///< k_t is multiplied by exp(-loss (L1/L3 - 1)) [-]
  double elongation = 0.0;  ///< share of L1/L2 - 1 in the index, the rest is L1/L3 - 1 [-]
  EffectArea where;

  void change_ground(Ground& ground, const Block& block, int day) const;
  void change_restitution(Restitution& k, const Block& block) const;
};

/// How far a block is from a sphere: between L1/L3 - 1 (elongation 0) and L1/L2 - 1 (elongation 1); 0 for a sphere [-].
inline double shape_index(const BlockShape& shape, const Block& block) {
  const double flat = block.axes[0] / block.axes[2] - 1.0, long_ = block.axes[0] / block.axes[1] - 1.0;
  return flat + shape.elongation * (long_ - flat);
}

/// block-shape: what psi_scale is multiplied by. docs/effects.md, "block-shape".
inline double shape_scatter(const BlockShape& shape, const Block& block) {
  return 1.0 + shape.lateral * shape_index(shape, block);
}

/// What k_t is multiplied by.
inline double shape_keeps(const BlockShape& shape, const Block& block) {
  return exponential(-shape.loss * shape_index(shape, block));
}

inline void BlockShape::change_ground(Ground& ground, const Block& block, int /*day*/) const {
  ground.psi_scale *= shape_scatter(*this, block);
}

inline void BlockShape::change_restitution(Restitution& k, const Block& block) const {
  k.tangential *= shape_keeps(*this, block);
}

}  // namespace talus
