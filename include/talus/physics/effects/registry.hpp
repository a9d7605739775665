#pragma once
#include <tuple>

#include "talus/physics/effects/air_drag.hpp"
#include "talus/physics/effects/block_mass.hpp"
#include "talus/physics/effects/block_shape.hpp"
#include "talus/physics/effects/effect_entry.hpp"
#include "talus/physics/effects/forest_stems.hpp"
#include "talus/physics/effects/fragmentation.hpp"
#include "talus/physics/effects/rest_in_roughness.hpp"
#include "talus/physics/effects/rolling_resistance.hpp"
#include "talus/physics/effects/soft_ground.hpp"
#include "talus/physics/effects/vegetation_drag.hpp"
#include "talus/physics/effects/wet_ground.hpp"

/// The list of all effects, which Talus adds to PIERRE 2: docs/effects.md. A new effect needs a line in `Effects` and
/// an entry in `kEntries`; all else follows from them. docs/adding-an-effect.md.
///
/// At an impact an effect acts by these member functions of its struct; it has only those that it needs:
/// `change_ground(ground, block, day)`, `change_restitution(k, block)`, `change_rebound(after, moment)` and
/// `holds(end)`.
namespace talus {

/// The parameters of each effect. By default each effect is off; off is bit-identical to absent.
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
  RestInRoughness rest_in_roughness;

  /// Whether one of them acts.
  bool any() const;
};

namespace registry {

inline constexpr auto kAbove = Bounds::AboveMin;

/// The entries, in the order of the files. Effects change the ground and the rebound of one impact in the same order.
inline constexpr std::tuple kEntries{
    entry<&Effects::vegetation_drag>(
        "vegetation-drag", Sought::InZones, 1,
        strength<&VegetationDrag::coefficient>(
            {"vegetation-drag.coefficient", "kg/s", "force per speed of the stand", 0.0, 5000.0},
            SearchRange{.lower = 0.0, .upper = 3.0, .noticed = 0.1, .times = Typical::BlockMass}),
        manner<&VegetationDrag::height>(
            {"vegetation-drag.height", "m", "of the stand above the ground", 0.0, 60.0, kAbove})),
    entry<&Effects::forest_stems>(
        "forest-stems", Sought::InZones, 2,
        by_cell(strength<&ForestStems::density>({"forest-stems.density", "1/ha", "stems per hectare", 0.0, 10000.0},
                                                SearchRange{.lower = 0.0, .upper = 3000.0, .noticed = 100.0})),
        by_cell(
            manner<&ForestStems::diameter>({"forest-stems.diameter", "m", "of the stems at breast height", 0.01, 3.0})),
        manner<&ForestStems::height>({"forest-stems.height", "m", "of the trees above the ground", 0.0, 60.0, kAbove}),
        manner<&ForestStems::species_factor>(
            {"forest-stems.species_factor", "1", "of the energy that a stem takes", 0.0, 10.0, kAbove})),
    entry<&Effects::block_shape>(
        "block-shape", Sought::OfShapes, 6,
        strength<&BlockShape::lateral>(
            {"block-shape.lateral", "1", "psi_scale is multiplied by 1 + lateral (L1/L3 - 1)", 0.0, 10.0},
            SearchRange{.lower = 0.0, .upper = 6.0, .noticed = 0.5}),
        strength<&BlockShape::loss>({"block-shape.loss", "1", "k_t is multiplied by exp(-loss (L1/L3 - 1))", 0.0, 5.0},
                                    SearchRange{.lower = 0.0, .upper = 2.0, .noticed = 0.1}),
        Number<&BlockShape::elongation>{
            .bounds = {"block-shape.elongation", "1", "share of L1/L2 in the index in place of L1/L3", 0.0, 1.0},
            .variants = {Variant{"by L1/L3", 0.0}, Variant{"by L1/L2", 1.0}}}),
    entry<&Effects::block_mass>(
        "block-mass", Sought::Everywhere, 7,
        strength<&BlockMass::roughness>(
            {"block-mass.roughness", "1", "theta_scale is multiplied by (D0/D)^roughness", -3.0, 3.0},
            SearchRange{.lower = -2.0, .upper = 2.0, .noticed = 0.4}),
        strength<&BlockMass::stiffness>(
            {"block-mass.stiffness", "1", "En50 is multiplied by (D/D0)^stiffness", -3.0, 3.0},
            SearchRange{.lower = -3.0, .upper = 3.0, .noticed = 0.8}),
        Number<&BlockMass::reference_diameter>{
            .bounds = {"block-mass.reference_diameter", "m", "D0, at which nothing changes", 0.01, 50.0},
            .set_to = Typical::BlockDiameter}),
    entry<&Effects::wet_ground>(
        "wet-ground", Sought::OnDays, 8,
        strength<&WetGround::softening>(
            {"wet-ground.softening", "1", "En50 is multiplied by exp(-softening) on a wet day", -5.0, 5.0},
            SearchRange{.lower = 0.0, .upper = 4.0, .noticed = 0.7}),
        strength<&WetGround::drag>({"wet-ground.drag", "1", "Et50 is multiplied by exp(-drag) on a wet day", -5.0, 5.0},
                                   SearchRange{.lower = 0.0, .upper = 4.0, .noticed = 0.7})),
    // M_E stays at 15 MN/m2 in a search. Soil of 2 MN/m2, with a deeper scar, acts like a drag 5 times larger.
    entry<&Effects::soft_ground>(
        "soft-ground", Sought::InZones, 3,
        strength<&SoftGround::drag>({"soft-ground.drag", "1", "C_d of the soil on the ploughing block", 0.0, 50.0},
                                    SearchRange{.lower = 0.0, .upper = 50.0, .noticed = 4.0}),
        manner<&SoftGround::stiffness>({"soft-ground.stiffness", "MN/m2", "M_E of the soil", 0.1, 1000.0}),
        manner<&SoftGround::scar_length>(
            {"soft-ground.scar_length", "m", "of the scar of an impact", 0.0, 20.0, kAbove})),
    entry<&Effects::rolling_resistance>(
        "rolling-resistance", Sought::InZones, 4,
        strength<&RollingResistance::coefficient>({"rolling-resistance.coefficient", "1", "mu_r", 0.0, 3.0},
                                                  SearchRange{.lower = 0.0, .upper = 2.0, .noticed = 0.2}),
        manner<&RollingResistance::hop>(
            {"rolling-resistance.hop", "1", "highest hop that counts as rolling, in radii", 0.0, 10.0, kAbove})),
    entry<&Effects::air_drag>(
        "air-drag", Sought::Everywhere, 5,
        strength<&AirDrag::coefficient>({"air-drag.coefficient", "1", "C_d of the block in the air", 0.0, 3.0},
                                        SearchRange{.lower = 0.0, .upper = 3.0, .noticed = 1.0})),
    entry<&Effects::fragmentation>(
        "fragmentation", Sought::Everywhere, 9,
        strength<&Fragmentation::threshold>(
            {"fragmentation.threshold", "J/kg",
             "normal energy lost at an impact, per mass, above which the block breaks", 0.0, 1e6},
            SearchRange{.lower = 0.0, .upper = 0.5, .noticed = 0.02, .inverse_unit = "kg/J"}),
        Number<&Fragmentation::largest>{
            .bounds = {"fragmentation.largest", "1", "share of the mass that the largest piece keeps", 0.5, 0.99},
            .search = SearchRange{.lower = 0.5, .upper = 0.99, .noticed = 0.15, .off = 0.7}}),
    entry<&Effects::rest_in_roughness>(
        "rest-in-roughness", Sought::InZones, 10,
        strength<&RestInRoughness::kappa>(
            {"rest-in-roughness.kappa", "1", "height that a block must be able to climb, in D tan(theta)", 0.0, 10.0},
            SearchRange{.lower = 0.0, .upper = 3.0, .noticed = 0.3})),
};

static_assert(members_of<Effects>() == std::tuple_size_v<decltype(kEntries)>,
              "each member of Effects must have its entry, and one only");

}  // namespace registry

/// The entries of all effects.
std::span<const EffectEntry> effect_entries();

/// The entry with this name; null if there is none.
const EffectEntry* find_effect(std::string_view name);

/// Calls visit(effect) with the parameters of each effect, in the order of the registry. The compiler unrolls the loop.
template <class AllEffects, class Visit>
void for_each_effect(AllEffects& effects, Visit visit) {
  std::apply([&](const auto&... entry) { (visit(effects.*entry.kMember), ...); }, registry::kEntries);
}

}  // namespace talus
