#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenario_spec.hpp"
#include "table_reader.hpp"
#include "talus/terrain/surface.hpp"

namespace talus::io {

/// Reads `fitted_cell`, `fitted_diameters` and `fitted_skill`, in the file of a model and in [fit].
void read_fitted(TableReader& table, FittedOn& fitted);

/// Reads [fit] of the scenario that a run has written: what is known of the fit of its ground.
void read_fit(ScenarioSpec& spec, TableReader table, const std::filesystem::path& base);

/// "4.3 % (95 %: 1.2 to 7.5 %)"; the share alone where the interval is not known.
std::string reduction_in_words(const Reduction& reduction);

/// The skill of such a list: [value], or [value, low, high] in this order. None for another list.
std::optional<Reduction> skill_of_list(std::span<const double> list);

/// "[-0.11, -0.25, 0.02]": value and interval; without an interval the value alone.
std::string skill_list(const Reduction& skill);

/// Warns where a model was fitted on another kind of surface, or on cells of another size, than it is used on: a ground
/// makes up for what its DEM does not show. docs/validation.md, "Cells and trajectories".
///
/// @param where  of the model: "fitted.toml"
/// @param used   "this run is", "the campaign is simulated"
/// @param remedy for another kind of surface
void warn_of_other_terrain(const ScenarioSpec& spec, const Grid& grid, SurfaceKind kind, const std::string& where,
                           const std::string& used, const std::string& remedy, std::vector<std::string>& warnings);

/// Whether a number of a ground is that of a fitted model.
bool is_of_fit(const ScenarioSpec& spec, const ZoneSpec& zone, const std::string& key);

/// Whether a ground of the scenario has such a number.
bool uses_fit(const ScenarioSpec& spec);

/// Words of two warnings, by which the report finds them.
inline constexpr const char* kOtherTerrain = "was fitted on";
inline constexpr const char* kOtherCoefficient = "was fitted with the deformation coefficient";

/// Whether a warning says that the fit of the ground does not hold in this run: one of the three here.
bool says_fit_does_not_hold(const std::string& warning);

/// Warns where the fit of the ground has no skill.
void warn_of_no_skill(const ScenarioSpec& spec, std::vector<std::string>& warnings);

/// Warns where a run changes c of the impact law under a ground that was fitted with another one.
void warn_of_other_coefficient(const ScenarioSpec& spec, std::vector<std::string>& warnings);

}  // namespace talus::io
