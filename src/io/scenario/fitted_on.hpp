#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "talus/terrain/surface.hpp"

namespace talus::io {

/// Warns where a model was fitted on another kind of surface, or on cells of another size, than it is used on: a ground
/// makes up for what its DEM does not show. docs/validation.md, "Cells and trajectories".
///
/// @param where  of the model: "fitted.toml"
/// @param used   "this run is", "the campaign is simulated"
/// @param remedy for another kind of surface
void warn_of_other_terrain(const ScenarioSpec& spec, const Grid& grid, SurfaceKind kind, const std::string& where,
                           const std::string& used, const std::string& remedy, std::vector<std::string>& warnings);

/// Whether a ground of the scenario has a number of the included model.
bool uses_fit(const ScenarioSpec& spec);

/// Warns where a run changes c of the impact law under a ground that was fitted with another one.
void warn_of_other_coefficient(const ScenarioSpec& spec, std::vector<std::string>& warnings);

}  // namespace talus::io
