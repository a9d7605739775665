#include <array>

#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus {

namespace {

template <auto effect, auto member>
constexpr double get(const Effects& e) {
  return e.*effect.*member;
}
template <auto effect, auto member>
constexpr void set(Effects& e, double value) {
  e.*effect.*member = value;
}

/// A strength: a number whose value 0 switches it off.
template <auto effect, auto member>
constexpr Field<Effects> strength(const Bounds& bounds) {
  return {bounds, get<effect, member>, set<effect, member>, 0.0};
}
/// A number that says how the effect acts.
template <auto effect, auto member>
constexpr Field<Effects> manner(const Bounds& bounds) {
  return {bounds, get<effect, member>, set<effect, member>};
}

constexpr auto kAbove = Bounds::AboveMin;

constexpr std::array kEffects{
    strength<&Effects::vegetation_drag, &VegetationDrag::coefficient>(
        {"vegetation-drag.coefficient", "kg/s", "force per speed of the stand", 0.0, 5000.0}),
    manner<&Effects::vegetation_drag, &VegetationDrag::height>(
        {"vegetation-drag.height", "m", "of the stand above the ground", 0.0, 60.0, kAbove}),
    strength<&Effects::forest_stems, &ForestStems::density>(
        {"forest-stems.density", "1/ha", "stems per hectare", 0.0, 10000.0}),
    manner<&Effects::forest_stems, &ForestStems::diameter>(
        {"forest-stems.diameter", "m", "of the stems at breast height", 0.01, 3.0}),
    manner<&Effects::forest_stems, &ForestStems::height>(
        {"forest-stems.height", "m", "of the trees above the ground", 0.0, 60.0, kAbove}),
    manner<&Effects::forest_stems, &ForestStems::species_factor>(
        {"forest-stems.species_factor", "1", "of the energy that a stem takes", 0.0, 10.0, kAbove}),
    strength<&Effects::block_shape, &BlockShape::lateral>(
        {"block-shape.lateral", "1", "psi_scale is multiplied by 1 + lateral (L1/L3 - 1)", 0.0, 10.0}),
    strength<&Effects::block_shape, &BlockShape::loss>(
        {"block-shape.loss", "1", "k_t is multiplied by exp(-loss (L1/L3 - 1))", 0.0, 5.0}),
    manner<&Effects::block_shape, &BlockShape::elongation>(
        {"block-shape.elongation", "1", "share of L1/L2 in the index in place of L1/L3", 0.0, 1.0}),
    strength<&Effects::block_mass, &BlockMass::roughness>(
        {"block-mass.roughness", "1", "theta_scale is multiplied by (D0/D)^roughness", -3.0, 3.0}),
    strength<&Effects::block_mass, &BlockMass::stiffness>(
        {"block-mass.stiffness", "1", "En50 is multiplied by (D/D0)^stiffness", -3.0, 3.0}),
    manner<&Effects::block_mass, &BlockMass::reference_diameter>(
        {"block-mass.reference_diameter", "m", "D0, at which nothing changes", 0.01, 50.0}),
    strength<&Effects::wet_ground, &WetGround::softening>(
        {"wet-ground.softening", "1", "En50 is multiplied by exp(-softening) on a wet day", -5.0, 5.0}),
    strength<&Effects::wet_ground, &WetGround::drag>(
        {"wet-ground.drag", "1", "Et50 is multiplied by exp(-drag) on a wet day", -5.0, 5.0}),
    strength<&Effects::soft_ground, &SoftGround::drag>(
        {"soft-ground.drag", "1", "C_d of the soil on the ploughing block", 0.0, 50.0}),
    manner<&Effects::soft_ground, &SoftGround::stiffness>(
        {"soft-ground.stiffness", "MN/m2", "M_E of the soil", 0.1, 1000.0}),
    manner<&Effects::soft_ground, &SoftGround::scar_length>(
        {"soft-ground.scar_length", "m", "of the scar of an impact", 0.0, 20.0, kAbove}),
    strength<&Effects::rolling_resistance, &RollingResistance::coefficient>(
        {"rolling-resistance.coefficient", "1", "mu_r", 0.0, 3.0}),
    manner<&Effects::rolling_resistance, &RollingResistance::hop>(
        {"rolling-resistance.hop", "1", "highest hop that counts as rolling, in radii", 0.0, 10.0, kAbove}),
    strength<&Effects::air_drag, &AirDrag::coefficient>(
        {"air-drag.coefficient", "1", "C_d of the block in the air", 0.0, 3.0}),
    strength<&Effects::fragmentation, &Fragmentation::threshold>(
        {"fragmentation.threshold", "J/kg", "energy lost across the plane of an impact, above which the block breaks",
         0.0, 1e6}),
    manner<&Effects::fragmentation, &Fragmentation::largest>(
        {"fragmentation.largest", "1", "share of the mass that the largest piece keeps", 0.5, 0.99}),
};

constexpr std::array<std::string_view, 9> kNames{"vegetation-drag",    "forest-stems", "block-shape",
                                                 "block-mass",         "wet-ground",   "soft-ground",
                                                 "rolling-resistance", "air-drag",     "fragmentation"};

}  // namespace

std::span<const Field<Effects>> effect_fields() {
  return kEffects;
}

std::span<const std::string_view> effect_names() {
  return kNames;
}

EffectArea* extent_of(Effects& e, std::string_view name) {
  const std::array<EffectArea*, 9> extents{
      &e.vegetation_drag.where, &e.forest_stems.where, &e.block_shape.where,        &e.block_mass.where,
      &e.wet_ground.where,      &e.soft_ground.where,  &e.rolling_resistance.where, nullptr,
      &e.fragmentation.where};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return extents[i];
  return nullptr;
}

}  // namespace talus
