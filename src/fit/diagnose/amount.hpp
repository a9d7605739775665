#pragma once
#include "talus/fit/diagnose/candidates.hpp"

namespace talus {

/// A parameter that is off at `off`, noticed at off + size, and searched on a linear scale.
inline Parameter amount(std::string key, std::string unit, double off, double size, double lower, double upper,
                        std::function<double(const Model&)> get, std::function<void(Model&, double)> set) {
  return {std::move(key),  std::move(unit), lower,         upper, Parameter::Scale::Linear, off,
          size / kNoticed, std::move(get),  std::move(set)};
}

}  // namespace talus
