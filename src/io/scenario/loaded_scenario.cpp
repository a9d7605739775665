#include "talus/io/scenario/loaded_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "barrier_keys.hpp"
#include "effect_places.hpp"
#include "fitted_on.hpp"
#include "io/files/checksum.hpp"
#include "scenario_flags.hpp"
#include "scenario_keys.hpp"
#include "scenario_text.hpp"
#include "size_warning.hpp"
#include "talus/base/error.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/layer_name.hpp"
#include "talus/io/gdal/lines.hpp"
#include "talus/io/gdal/vectors.hpp"
#include "talus/io/gdal/zones.hpp"
#include "talus/simulate/scenario/presets.hpp"
#include "talus/terrain/pits.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus::io {

namespace {

/// Names files by the places beside the results (`RunFlags::Recorded`), as they lay when these were written. Parts of
/// files (NETCDF:...), archives and addresses keep their names.
void follow(ScenarioSpec& spec, const RunFlags& flags) {
  namespace fs = std::filesystem;
  if (flags.recorded.folder.empty()) return;
  const fs::path now = fs::absolute(flags.scenario).parent_path();
  for (const auto& [role, file] : spec.inputs()) {
    const fs::path path = file_of_layer(file->path);
    std::error_code none;
    if (!path.is_absolute() || path.string().starts_with("/vsi")) continue;
    if (!flags.recorded.beside_first && fs::exists(path, none)) continue;
    const fs::path beside = (now / path.lexically_relative(flags.recorded.folder)).lexically_normal();
    if (fs::is_regular_file(beside, none)) file->path = same_layer_in(beside.string(), file->path);
  }
}

// Adds a fault for each file that is not there, before any is opened.
void check_files(const ScenarioSpec& spec, std::vector<std::string>& faults) {
  std::vector<const NamedFile*> files;
  for (const auto& [role, file] : spec.inputs())
    if (file != &spec.scenario) files.push_back(file);
  check_encoding(files, faults);
  check_files(files, faults);
}

[[noreturn]] void refuse_first(const std::string& first, std::size_t count) {
  const std::size_t more = count - 1;
  throw InputError(more == 0 ? first
                             : first + " (and " + std::to_string(more) + (more == 1 ? " more fault" : " more faults") +
                                   ": talus check lists all)");
}

void stop_at_faults(const std::vector<std::string>& faults, std::vector<std::string>* all) {
  if (all != nullptr) *all = faults;
  if (!faults.empty()) refuse_first(faults.front(), faults.size());
}

template <class Part>
void take(LoadedScenario& out, const Part& part) {
  out.reprojections.insert(out.reprojections.end(), part.reprojections.begin(), part.reprojections.end());
  out.warnings.insert(out.warnings.end(), part.warnings.begin(), part.warnings.end());
}

/// The same of a layer with notes on its fields.
template <class Part>
void take_all(LoadedScenario& out, const Part& part) {
  take(out, part);
  out.notes.insert(out.notes.end(), part.notes.begin(), part.notes.end());
}

void load_ground(ScenarioSpec& spec, const Terrain& terrain, Scenario& parts, LoadedScenario& out) {
  parts.cover.grounds = {spec.default_ground.ground};
  parts.zone_names = {"default"};
  for (const ZoneSpec& zone : spec.zones) {
    parts.cover.grounds.push_back(zone.ground);
    parts.zone_names.push_back(zone.name);
  }
  if (spec.ground.path.empty()) return;
  ZoneRequest request{spec.ground.path, spec.ground_field, {parts.zone_names.begin() + 1, parts.zone_names.end()}};
  for (const ZoneSpec& zone : spec.zones) request.codes.push_back(zone.code);
  request.default_code = spec.default_ground.code;
  for (const Preset& preset : presets()) request.presets.emplace_back(preset.name);
  ZoneLayer layer = read_zones(request, terrain);
  for (const std::string& name : layer.presets) {
    spec.zones.push_back({name, name, find_preset(name).ground, {}, {}});
    parts.cover.grounds.push_back(spec.zones.back().ground);
    parts.zone_names.push_back(name);
    out.notes.push_back(spec.ground.path + ": zone " + name + " is the preset of this name");
  }
  parts.cover.zones = std::move(layer.zones);
  spec.ground_field = layer.field;
  take_all(out, layer);
}

/// The barriers of the layer, then those that the scenario names by their ends.
void load_barriers(const ScenarioSpec& spec, const Terrain& terrain, Scenario& parts, LoadedScenario& out) {
  BarrierLayer layer;
  if (!spec.barriers.path.empty()) {
    layer = read_barriers(spec.barriers.path, terrain);
    take_all(out, layer);
  }
  const std::size_t of_layer = layer.barriers.size();
  for (const BarrierLine& line : spec.barrier_lines) layer.barriers.push_back(barrier_of(line, terrain.heights.grid));
  warn_of_barriers_off("barriers.line (" + spec.origin("barriers.line") + ")",
                       std::span(layer.barriers).subspan(of_layer), terrain, out.warnings);
  warn_of_unsaid_capacities(spec.barrier_lines, out.warnings);
  warn_of_unlikely_barriers(layer.barriers, out.warnings);
  warn_of_equal_ids(layer.barriers, out.warnings);
  parts.barriers = Barriers(std::move(layer.barriers));
}

// A run without any diameter is the most frequent fault of a first scenario: say all ways to give one.
void check_diameters(const Scenario& parts, const SourceLayer& layer, const std::string& path) {
  if (!parts.blocks.classes.empty() || parts.blocks.power_law.volume.high != 0.0) return;
  for (const SourceCell& cell : layer.cells) {
    if (!std::isnan(layer.features[cell.feature].diameter.low)) continue;
    throw InputError(
        path + ": feature " + std::to_string(layer.features[cell.feature].id) +
        " has no block diameter, must have one (there is no default block): give [blocks] diameter in the "
        "scenario, --diameter M, or a field diameter "
        "(or diameter_min and diameter_max) of the sources, in m; --field diameter=COLUMN where it has another "
        "name (its fields: " +
        (layer.fields.empty() ? "none" : shortened(joined(layer.fields), 300)) +
        "); a block of volume V has the diameter (6 V / pi)^(1/3)");
  }
}

/// Diameters that no block gets, because every feature has its own: easily overlooked.
void warn_unused_diameter(const ScenarioSpec& spec, const SourceLayer& layer, std::vector<std::string>& warnings) {
  const std::string origin = spec.origin("blocks.diameter");
  if (origin == "default" || layer.features.empty()) return;
  Range all{1e9, 0.0};
  for (const SourceFeature& feature : layer.features) {
    if (std::isnan(feature.diameter.low)) return;
    all = {std::min(all.low, feature.diameter.low), std::max(all.high, feature.diameter.high)};
  }
  warnings.push_back(
      "blocks.diameter (" + origin + ") is not used: all " + std::to_string(layer.features.size()) + " features of " +
      spec.sources.path + " have diameters of their own, " + text_of(all.low) + " to " + text_of(all.high) +
      " m (to leave the fields out: --field diameter=, --field diameter_min= and --field diameter_max=)");
}

/// Whether the ground around a cell is steeper than half of its friction angle. On flatter ground blocks come to rest
/// also without a dam, and the noise of a survey alone makes dams: docs/physics.md, "Creases".
bool steep_enough_for_dams(const Raster<float>& heights, const Cover& cover, int column, int row) {
  const Grid& grid = heights.grid;
  const Ground& ground = cover.grounds[cover.zone_at(grid.centre_x(column), grid.centre_y(row))];
  return horn_slope(heights, column, row) > std::tan(0.5 * std::atan(ground.tan_phi));
}

/// How many cells are steep; of a large DEM by about a million of its cells, which is enough for a share.
template <class IsSteep>
double number_of_steep(const Raster<float>& heights, const IsSteep& is_steep) {
  constexpr double kEnough = 1e6;
  const Grid& grid = heights.grid;
  const int every = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(heights.values.size()) / kEnough)));
  double number = 0.0;
  for_each_row(heights, [&](int row) {
    if (row % every != 0) return;
    for (int column = 0; column < grid.columns; column += every)
      if (is_steep(column, row)) number += every * every;
  });
  return number;
}

/// Steep gullies narrower than two cells are sampled as staircases, whose treads hold blocks.
void warn_of_dams(const Surface& surface, const Cover& cover, std::vector<std::string>& warnings) {
  constexpr double kManyDams = 2e-4;  // of the steep cells; mountain sides with gullies in cells of 5 m: 0.03 to 0.07 %
  const Raster<float>& heights = surface.heights();
  const auto is_steep = [&](int column, int row) { return steep_enough_for_dams(heights, cover, column, row); };
  const DamCount count = count_dammed(heights, is_steep);
  if (count.dammed == 0) return;
  const double share = static_cast<double>(count.dammed) / std::max(1.0, number_of_steep(heights, is_steep));
  if (share < kManyDams) return;
  const bool one = count.dammed == 1;
  const std::string cells = std::to_string(count.dammed) + (one ? " cell" : " cells") + " of the DEM (" +
                            percent(share, 2) + " of the ground steeper than half of its friction angle) " +
                            (one ? "has" : "have") + " a way down only diagonally: ";
  warnings.push_back(cells +
                     (surface.creased()
                          ? "gullies narrower than two cells. The surface is creased there, so that it dams none; "
                            "but such gullies are sampled as staircases, whose treads can hold blocks: take a "
                            "finer DEM if gullies matter"
                          : "a bilinear surface dams them, and they can hold a quarter of the blocks that stop: "
                            "take surface = \"creased\", or a finer DEM"));
}

/// Warns where the fit of the ground has no skill, or the run differs from it.
void warn_of_fit(const ScenarioSpec& spec, const Grid& grid, std::vector<std::string>& warnings) {
  const FittedOn& fitted = spec.fitted_on;
  warn_of_no_skill(spec, warnings);
  warn_of_other_terrain(spec, grid, spec.surface, fitted.file.where, "this run is",
                        " (" + spec.origin("surface") + "): fit it again, or " +
                            (spec.include.path.empty() && fitted.surface
                                 ? "take surface = \"" + std::string(name_of(*fitted.surface)) + "\""
                                 : "leave `surface` to the included file"),
                        warnings);
  warn_of_other_coefficient(spec, warnings);
}

/// The file of the fitted model with its checksum: as included, or as [fit] names it, which is not read again.
void record_fit(ScenarioSpec& spec, std::vector<InputFile>& inputs) {
  FittedOn& fitted = spec.fitted_on;
  const auto included = std::ranges::find(inputs, kFittedModel, &InputFile::role);
  if (included != inputs.end())
    fitted.sha256 = included->sha256;
  else if (!fitted.file.path.empty())
    inputs.insert(inputs.begin() + 1, {kFittedModel, fitted.file.path, fitted.sha256});
}

SourceLayer load_sources(const ScenarioSpec& spec, const Terrain& terrain, const Scenario& parts, LoadedScenario& out) {
  SourceLayer sources = read_sources(spec.sources.path, terrain, spec.release_height, spec.source_fields);
  out.notes.push_back(sources.read_note);
  out.notes.insert(out.notes.end(), sources.unread_notes.begin(), sources.unread_notes.end());
  out.unread_height = sources.unread_height;
  check_diameters(parts, sources, spec.sources.path);
  out.warnings.insert(out.warnings.end(), spec.warnings.begin(), spec.warnings.end());
  warn_unused_diameter(spec, sources, out.warnings);
  take(out, sources);
  return sources;
}

}  // namespace

LoadedScenario load_scenario(const RunFlags& flags, std::vector<std::string>* all_faults, const RasterMemory& memory,
                             int threads) {
  std::vector<std::string> faults;
  ScenarioSpec spec = read_spec(flags, faults);
  follow(spec, flags);
  check_files(spec, faults);
  stop_at_faults(faults, all_faults);

  LoadedScenario out;
  const auto attempt = [&](const std::function<void()>& read) {  // with `all_faults`, goes on with the next layer
    try {
      read();
    } catch (const InputFaults& error) {
      if (all_faults == nullptr) refuse_first(error.faults().front(), error.count());
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    } catch (const InputError& error) {
      if (all_faults == nullptr) throw;
      faults.emplace_back(error.what());
    }
  };
  Terrain terrain = read_terrain(spec.dem.path, memory, threads);
  out.warnings = terrain.warnings;
  out.geo = terrain.geo;
  Scenario parts = spec.values;
  SourceLayer sources;
  attempt([&] { sources = load_sources(spec, terrain, parts, out); });
  attempt([&] { load_ground(spec, terrain, parts, out); });
  attempt([&] { load_effect_places(spec, terrain, parts, out); });
  if (!spec.screens.path.empty())
    attempt([&] {
      ScreenLayer screens = read_screens(spec.screens.path, terrain);
      parts.screens = std::move(screens.screens);
      take_all(out, screens);
    });
  attempt([&] { load_barriers(spec, terrain, parts, out); });
  if (!spec.instrument_bias.empty())
    out.warnings.push_back(spec.include.where +
                           ": its [[instrument_bias]] is left out: it says how instruments of the "
                           "campaign read, and belongs to no place");
  warn_of_fit(spec, terrain.heights.grid, out.warnings);
  stop_at_faults(faults, all_faults);
  parts.features = std::move(sources.features);
  parts.sources = std::move(sources.cells);
  parts.surface = Surface(std::move(terrain.heights), spec.surface);
  warn_of_dams(parts.surface, parts.cover, out.warnings);
  out.scenario = make_scenario(std::move(parts));
  warn_of_unused_preset(spec, out.warnings);
  warn_of_sizes(spec, out.scenario, out.warnings);
  tell_of_effects(out);

  for (const auto& [role, file] : spec.inputs()) out.inputs.push_back(recorded_input(role, file->path));
  record_fit(spec, out.inputs);
  out.complete_toml = toml_of(spec);
  out.settings = settings_of(spec);
  out.spec = std::make_shared<ScenarioSpec>(spec);
  out.settings.insert(out.settings.end(), sources.attributes.begin(), sources.attributes.end());
  return out;
}

void set_rounds(LoadedScenario& loaded, std::uint32_t rounds) {
  ScenarioSpec spec = *loaded.spec;
  loaded.scenario.trajectories *= rounds;
  spec.values.trajectories = loaded.scenario.trajectories;
  loaded.complete_toml = toml_of(spec);
  loaded.spec = std::make_shared<ScenarioSpec>(std::move(spec));
}

}  // namespace talus::io
