#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "talus/terrain/raster.hpp"

namespace talus {

/// What PIERRE 2 leaves out: the parameters of each effect, named as in scenario and diagnosis. docs/effects.md.
/// A fresh one is off, and off is bit-identical to absent.

/// Where an effect acts: everywhere, in some zones, or in the cells of a mask (polygons).
struct EffectArea {
  std::vector<std::uint8_t> zones;  ///< by zone of the cover: 1 where it acts; empty: in all of them
  Raster<std::uint8_t> mask;        ///< 1 where it acts; empty: everywhere

  bool covers(std::uint8_t zone, double x, double y) const {
    return (zones.empty() || zones[zone] != 0) &&
           (mask.values.empty() || mask.at(mask.grid.column_of(x), mask.grid.row_of(y)) != 0);
  }
};

/// Undergrowth and trees as a force c v against the motion, below the height of the stand.
struct VegetationDrag {
  double coefficient = 0.0;  ///< c [kg/s]; 0: off
  double height = 10.0;      ///< of the stand [m]
  EffectArea where;
};

/// Single stems, met at random.
struct ForestStems {
  double density = 0.0;         ///< [stems per hectare]; 0: off
  double diameter = 0.3;        ///< DBH [m]
  double height = 20.0;         ///< of the trees [m]
  double species_factor = 1.0;  ///< of the energy a stem takes; 1: silver fir [-]
  EffectArea where;
};

/// Air resistance, 1/2 rho C_d A v^2.
struct AirDrag {
  double coefficient = 0.0;  ///< C_d [-]; 0: off
};

/// Blocks that are no spheres: an index i of their axes, L1/L3 - 1 unless elongation says otherwise, widens the lateral
/// scatter and takes tangential speed.
struct BlockShape {
  double lateral = 0.0;     ///< psi_scale is multiplied by 1 + lateral (L1/L3 - 1) [-]
  double loss = 0.0;        ///< k_t is multiplied by exp(-loss (L1/L3 - 1)) [-]
  double elongation = 0.0;  ///< share of L1/L2 - 1 in the index, the rest is L1/L3 - 1 [-]
  EffectArea where;
};

/// How roughness and damping change with the size of the block.
struct BlockMass {
  double roughness = 0.0;           ///< theta_scale is multiplied by (D0/D)^roughness [-]
  double stiffness = 0.0;           ///< En50 is multiplied by (D/D0)^stiffness [-]
  double reference_diameter = 1.0;  ///< D0 [m]
  EffectArea where;
};

/// Ground that is softer on wet days.
struct WetGround {
  double softening = 0.0;  ///< En50 is multiplied by exp(-softening) on a wet day [-]
  double drag = 0.0;       ///< Et50 is multiplied by exp(-drag) on a wet day [-]
  std::vector<int> days;   ///< the wet ones
  EffectArea where;
};

/// Soft soil in which the block ploughs a scar.
struct SoftGround {
  double drag = 0.0;         ///< C_d of the soil [-]; 0: off
  double stiffness = 15.0;   ///< M_E [MN/m^2]
  double scar_length = 1.5;  ///< [m]
  EffectArea where;
};

/// Resistance to rolling, once the block hops no higher than a share of its radius.
struct RollingResistance {
  double coefficient = 0.0;  ///< mu_r [-]; 0: off
  double hop = 0.5;          ///< highest hop that counts as rolling, in radii [-]
  EffectArea where;
};

/// A block that breaks at a hard impact.
struct Fragmentation {
  double threshold = 0.0;  ///< energy lost across the plane, per mass, above which it breaks [J/kg]; 0: never
  double largest = 0.5;    ///< share of the mass that the largest piece keeps, in [1/2, 1)
  EffectArea where;
};

/// All of them.
struct Effects {
  VegetationDrag vegetation_drag;
  ForestStems forest_stems;
  AirDrag air_drag;
  BlockShape block_shape;
  BlockMass block_mass;
  WetGround wet_ground;
  SoftGround soft_ground;
  RollingResistance rolling_resistance;
  Fragmentation fragmentation;

  bool any() const {
    return vegetation_drag.coefficient > 0.0 || forest_stems.density > 0.0 || air_drag.coefficient > 0.0 ||
           block_shape.lateral != 0.0 || block_shape.loss != 0.0 || block_mass.roughness != 0.0 ||
           block_mass.stiffness != 0.0 || wet_ground.softening != 0.0 || wet_ground.drag != 0.0 ||
           soft_ground.drag > 0.0 || rolling_resistance.coefficient > 0.0 || fragmentation.threshold > 0.0;
  }
};

}  // namespace talus
