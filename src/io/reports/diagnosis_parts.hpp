#pragma once
#include "io/files/json.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"

/// Parts of diagnosis.json that are the same for one campaign and for several.
namespace talus::io {

/// An item of `families`.
Json family_json(const FamilyTest& family);
/// An item of `candidates`, with what the choice among the effects rests on.
Json effect_json(const FittedEffect& effect);
/// `trials_per_block`.
Json trials_json(const TrialsPerBlock& trials);

}  // namespace talus::io
