#pragma once
#include "talus/fit/calibrate/parameters.hpp"
#include "talus/physics/effects/registry.hpp"

namespace talus {

/// Medians over the blocks that may be fitted. Searches of the registry may be multiples of them.
struct TypicalBlock {
  double mass, diameter;  ///< [kg], [m]

  double of(Typical typical) const {
    return typical == Typical::BlockMass ? mass : typical == Typical::BlockDiameter ? diameter : 1.0;
  }
};

TypicalBlock typical_block(const Campaign& campaign);

/// The search of one number of an effect, cut off at its bounds, or of the number's inverse. The centre of its prior is
/// the off value, its sd the amount that one would notice.
Parameter effect_parameter(const EffectEntry& entry, const EffectField& field, const TypicalBlock& typical);

/// The parameters `keys`, such as "effects.rest-in-roughness.kappa". The effect acts where and when it does in `start`.
///
/// @param noticed  z of the amount that one would notice, (0, 1]: the prior is that much wider
///
/// Throws InputError for a key that cannot be fitted.
std::vector<Parameter> effect_parameters(const Campaign& campaign, const Model& start,
                                         std::span<const std::string> keys, double noticed);

}  // namespace talus
