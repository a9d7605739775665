#pragma once
#include "scenario_spec.hpp"
#include "table_reader.hpp"
#include "talus/io/gdal/rasters.hpp"

namespace talus::io {

/// Reads [effects] with its tables into spec.values.effects and spec.effects.
void read_effects(ScenarioSpec& spec, TableReader table, const std::filesystem::path& base, const std::string& origin);

/// Adds a fault for each zone of an effect that the input does not describe.
void check_effect_zones(const ScenarioSpec& spec, std::vector<std::string>& faults);

/// Fills in where the effects act: their zones by number, their polygons as masks on the grid of the DEM.
void load_effect_places(const ScenarioSpec& spec, const Terrain& terrain, Scenario& parts, LoadedScenario& out);

}  // namespace talus::io
