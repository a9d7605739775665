#pragma once
#include "talus/fit/calibrate/parameters.hpp"

namespace talus {

/// A parameter that is off at `off`, noticed at off + size, and searched on a linear scale. Its sd is `size`: what one
/// would notice is at z = 1 until `candidates_of` makes the prior wider.
inline Parameter amount(std::string key, std::string unit, double off, double size, double lower, double upper,
                        std::function<double(const Model&)> get, std::function<void(Model&, double)> set) {
  return {std::move(key), std::move(unit), lower,         upper, Parameter::Scale::Linear, off,
          size,           std::move(get),  std::move(set)};
}

}  // namespace talus
