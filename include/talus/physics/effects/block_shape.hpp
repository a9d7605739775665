#pragma once
#include "talus/base/elementary.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects.hpp"

namespace talus {

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

}  // namespace talus
