#pragma once
#include <cstdint>
#include <limits>
#include <string>

#include "talus/base/error.hpp"

namespace talus {

/// Adds whole numbers to a count or a sum of the results. Throws InputError if the sum has more bits than it is kept
/// in: a count that begins anew at 0 would be a wrong map.
template <class Whole>
void add_checked(Whole& sum, Whole more) {
  if (__builtin_add_overflow(sum, more, &sum))
    throw InputError("a count or sum of one cell becomes larger than " +
                     std::to_string(std::numeric_limits<Whole>::max()) +
                     ", the most that it can hold: give fewer trajectories or rounds, or merge fewer of them");
}

/// A value >= 0 for a sum in fixed point. @param units  of the sum in 1
inline std::int64_t fixed_point(double value, double units) {
  return static_cast<std::int64_t>(value * units + 0.5);
}

}  // namespace talus
