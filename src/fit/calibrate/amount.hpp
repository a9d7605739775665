#pragma once
#include "talus/fit/calibrate/parameters.hpp"
#include "talus/physics/effects/effect_entry.hpp"

namespace talus {

/// A parameter that is searched on a linear scale from the value at which it is off. Its sd is `noticed`: what one
/// would notice is at z = 1 until `candidates_of` makes the prior wider.
inline Parameter amount(std::string key, std::string unit, const SearchRange& range,
                        std::function<double(const Model&)> get, std::function<void(Model&, double)> set) {
  return {std::move(key), std::move(unit), range.lower,    range.upper,   Parameter::Scale::Linear,
          range.off,      range.noticed,   std::move(get), std::move(set)};
}

}  // namespace talus
