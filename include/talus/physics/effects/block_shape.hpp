#pragma once
#include "talus/base/elementary.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/impact.hpp"

namespace talus {

/// Blocks that are not spheres: the lateral scatter and the loss of tangential speed grow with a shape index of the
/// axes. The index is L1/L3 - 1 if elongation is 0.
struct BlockShape {
  double lateral = 0.0;     ///< psi_scale is multiplied by 1 + lateral index [-]
  double loss = 0.0;        ///< k_t is multiplied by exp(-loss index) [-]
  double elongation = 0.0;  ///< share of L1/L2 - 1 in the index; the rest is L1/L3 - 1 [-]
  EffectArea where;

  void change_ground(Ground& ground, const Block& block, int day) const;
  void change_restitution(Restitution& k, const Block& block) const;
};

/// Shape index of a block, from L1/L3 - 1 (elongation 0) to L1/L2 - 1 (elongation 1); 0 for a sphere [-].
inline double shape_index(const BlockShape& shape, const Block& block) {
  const double flat = block.axes[0] / block.axes[2] - 1.0, elongated = block.axes[0] / block.axes[1] - 1.0;
  return flat + shape.elongation * (elongated - flat);
}

/// block-shape: factor on psi_scale. docs/effects.md, "block-shape".
inline double shape_scatter(const BlockShape& shape, const Block& block) {
  return 1.0 + shape.lateral * shape_index(shape, block);
}

/// Factor on k_t.
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
