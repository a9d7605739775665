#pragma once
#include "talus/physics/effects/effect_area.hpp"

namespace talus {

/// Undergrowth and trees as a force c v against the motion, below the height of the stand.
struct VegetationDrag {
  double coefficient = 0.0;  ///< c [kg/s]; 0: off
  double height = 10.0;      ///< of the stand [m]
  EffectArea where;
};

/// Share of the speed lost per second, above which a block is stuck in the vegetation [1/s]: drag takes more than 4 %
/// of its speed in the shortest piece of a flight, 0.01 s. docs/effects.md, "Flight with drag".
inline constexpr double kStuckRate = 4.0;

/// vegetation-drag: share of the speed lost per second, c/m [1/s]; 0 at the top of the stand and above.
///
/// @param clearance  height of the block above the ground [m]
/// Source: Leine et al. (2014), as in RAMMS::Rockfall; docs/effects.md, "vegetation-drag".
inline double vegetation_drag_rate(const VegetationDrag& drag, double mass, double clearance) {
  return clearance < drag.height ? drag.coefficient / mass : 0.0;
}

}  // namespace talus
