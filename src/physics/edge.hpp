#pragma once
#include "slope.hpp"

namespace talus {

/// Result of a piece along an edge.
enum class EdgeEnd { Moved, Held };

/// Slides a block along the concave edge between two patches that both press it back onto the edge. This is the limit
/// of crossing the edge to and fro. The block turns along the edge and keeps its speed. Gravity acts along the edge;
/// friction is the mean of the two slopes. The piece ends at the end of the edge, where the friction of the ground
/// changes, or after a quarter of a cell.
/// docs/physics.md, "Sliding".
///
/// @param slope     the patch of the block
/// @param beyond    the patch on the other side of the edge
/// @param farthest  longest way [m]
/// @return          Held if the block is at rest and friction exceeds gravity along the edge, or if it has no velocity
///                  along a level edge
EdgeEnd slide_along_edge(const Slope& slope, const Slope& beyond, Motion& motion, double farthest, Path& path);

}  // namespace talus
