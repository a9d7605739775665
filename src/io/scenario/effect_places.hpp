#pragma once
#include "scenario_spec.hpp"
#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// Fills in where the effects act: their zones by number, their polygons as masks on the grid of the DEM.
void load_effect_places(const ScenarioSpec& spec, const Terrain& terrain, Scenario& parts, LoadedScenario& out);

/// Finds the effects that are on: adds a note for each that acts, and warnings about those that do nothing, and about
/// stands.
void tell_of_effects(LoadedScenario& out);

}  // namespace talus::io
