#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// The value of model.deformation_coefficient (c) in a run.json; nothing if it is not there.
std::optional<double> deformation_coefficient_of(const std::filesystem::path& folder);

/// The part of OUT/run.json that products of a finished run need.
struct RunSummary {
  double released = 0.0;                   ///< trajectories
  double density = 0.0;                    ///< of the rock [kg/m^3]
  double cell = 0.0;                       ///< side of a cell, from west to east [m]
  std::vector<Screen> screens;             ///< in map coordinates [m]
  std::vector<std::string> size_warnings;  ///< that its blocks have other sizes than its ground was fitted to
};

/// Reads OUT/run.json. Throws InputError if it cannot be read or `talus run` has not written it.
RunSummary read_run(const std::filesystem::path& folder);

/// RunSummary::size_warnings alone; none if there is no run.json that can be read.
std::vector<std::string> size_warnings_of(const std::filesystem::path& folder);

}  // namespace talus::io
