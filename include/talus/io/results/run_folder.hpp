#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// What a finished run says of itself: the part of OUT/run.json that its products need.
struct RunSummary {
  double released = 0.0;        ///< trajectories
  double density = 0.0;         ///< of the rock [kg/m^3]
  double cell = 0.0;            ///< side of a cell, from west to east [m]
  std::vector<Screen> screens;  ///< in map coordinates [m]
};

/// Reads OUT/run.json. Throws InputError where the folder is no result of `talus run`, or of one that kept no screens.
RunSummary read_run(const std::filesystem::path& folder);

}  // namespace talus::io
