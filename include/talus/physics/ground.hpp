#pragma once
#include <cstdint>
#include <vector>

#include "talus/base/vector.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {

/// The parameters of one kind of ground: PIERRE 2, Tables 1-3. docs/physics.md, "Parameter sets".
template <class Number>
struct BasicGround {
  Number theta_scale = 0.0;  ///< longitudinal roughness [-]
  Number psi_scale = 0.0;    ///< transverse roughness [-]
  Number En50 = 15.0;        ///< c D v_n^2 at which half of the normal momentum is kept [m^3/s^2]
  Number Et50 = 50.0;        ///< c D v_n^2 at which half of the tangential momentum is kept [m^3/s^2]
  Number tan_phi =
      0.57735026918962562;  ///< tangent of the friction angle phi [-]: 30 degrees, as the program rounds it
  Number shape_min = 1.0, shape_max = 1.0;  ///< range of the factor on the radius at impact [-]
};
using Ground = BasicGround<double>;

/// The kinds of ground and their zones. A place has the ground of its cell.
struct Cover {
  std::vector<Ground> grounds;  ///< at least one
  Raster<std::uint8_t> zones;   ///< index into `grounds`; empty if the ground is the same everywhere

  std::uint8_t zone_at(double x, double y) const {
    return zones.values.empty() ? std::uint8_t{0} : zones.at(zones.grid.column_of(x), zones.grid.row_of(y));
  }
};

}  // namespace talus
