#pragma once
#include <vector>

#include "talus/base/vector.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {

/// Terrain of the 2D model: a polyline z(x).
struct Profile {
  std::vector<Eigen::Vector2d> nodes;  ///< (x, z) [m], x ascending; at least two

  double from() const { return nodes.front().x(); }
  double to() const { return nodes.back().x(); }
  /// Height at x, between `from` and `to` [m]; outside, the height of the nearer end.
  double height(double x) const;
};

/// A profile as a surface that is constant across it: two rows of cells. The engine treats it as any DEM.
///
/// The centre of column c is at x = from + c step. So a node at a multiple of `step` from the first node is exact in x,
/// and any other is moved by at most step / 2: beside it the height is off by up to the slope times that.
///
/// Heights are multiples of 2^(k - 24) m, where 2^k m is above half the relief + 1 m. A node is off by half of this at
/// most: 0.01 mm for a relief of up to 500 m. A segment is one plane to the last bit if its rise is the same multiple
/// in each column, as on level ground. Otherwise it is two, of which the second rises by one multiple more in each
/// column: their edge is concave, so that a block that slides over it stays on the ground and keeps its speed. A
/// segment lies by at most (its columns) 2^(k - 26) m below the straight line between its nodes: 4 mm for 100 m in
/// steps of 0.1 m and a relief of up to 500 m.
struct ExtrudedProfile {
  Raster<float> heights;  ///< above `datum` [m]; grid.west is `from` - step / 2, grid.south is -kProfileLine
  double datum = 0.0;     ///< [m]
};

/// y of the blocks on an extruded profile, half-way between its two rows [m, local].
inline constexpr double kProfileLine = 1.0;

/// Makes the surface of a profile.
///
/// @param step  size of a cell along the profile [m], > 0; at most the smallest distance of two nodes in x
ExtrudedProfile extrude(const Profile& profile, double step);

}  // namespace talus
