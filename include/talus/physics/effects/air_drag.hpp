#pragma once
#include "talus/physics/block.hpp"

namespace talus {

/// Air resistance, 1/2 rho C_d A v^2.
struct AirDrag {
  double coefficient = 0.0;  ///< C_d [-]; 0: off
};

inline constexpr double kAirDensity = 1.2;  ///< at 15 degrees Celsius, 200 m above sea level [kg/m^3]

/// air-drag: share of the speed lost per metre, 1/2 rho C_d A / m [1/m], with the cross-section A of the sphere.
/// Source: the drag equation; docs/effects.md, "air-drag".
inline double air_drag_rate(const AirDrag& drag, const Block& block) {
  return 0.5 * kAirDensity * drag.coefficient * kPi * block.radius() * block.radius() / block.mass;
}

}  // namespace talus
