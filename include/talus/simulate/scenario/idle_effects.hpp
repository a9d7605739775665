#pragma once
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// A line for each effect that is on, and can do nothing in this scenario: on other days than that of the run, or on
/// the shape of blocks that are spheres.
std::vector<std::string> idle_effects(const Scenario& scenario);

}  // namespace talus
