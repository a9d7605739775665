#pragma once
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// Warnings about the stand of an effect that acts (`EffectUse`), one line each: a forest with fewer stems or more wood
/// than any has, and vegetation-drag that holds the smallest blocks in the air. None of other effects. docs/effects.md.
std::vector<std::string> stand_warnings(const EffectEntry& entry, const Scenario& scenario);

}  // namespace talus
