#pragma once
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// Warnings about the stand of an effect that acts (`EffectUse`), one line each: a forest with fewer stems than
/// any has. None of other effects. docs/effects.md.
std::vector<std::string> stand_warnings(const EffectEntry& entry, const Scenario& scenario);

}  // namespace talus
