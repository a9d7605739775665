#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "talus/io/scenario/profile_file.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {

/// The spacing of the columns of a profile.
inline constexpr Bounds kProfileStep{"step", "m", "spacing of the columns", 0.05, 10.0};

/// Whether two nodes of a profile are at least a step apart, but for rounding.
/// @param distance  in x [m]
inline bool is_a_step(double distance, double step) {
  constexpr double kRounding = 1e-9;  // of `step`
  return distance >= (1.0 - kRounding) * step;
}

/// Reads the flags and the file of a profile as `read_spec` reads a scenario; `profile` of the result is set.
ScenarioSpec read_profile_spec(const ProfileFlags& flags, std::vector<std::string>& faults);

}  // namespace talus::io
