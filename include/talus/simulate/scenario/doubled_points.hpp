#pragma once
#include <string>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// How the warning below begins, in run.json, too.
inline constexpr const char* kDoubledPoints = "points of sources: ";

/// One line if points of the sources have the same place and the same fields as another, as where a layer was pasted
/// twice; empty if none have.
std::string doubled_points_warning(const Scenario& scenario);

}  // namespace talus
