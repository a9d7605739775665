#include "effect_places.hpp"

#include <algorithm>

#include "io/gdal/idle_features.hpp"
#include "io/gdal/layer.hpp"
#include "talus/io/gdal/forest.hpp"
#include "talus/io/gdal/rasters.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/stand_warnings.hpp"

namespace talus::io {

namespace {

/// Tells which fields the polygons of an effect have. Warns of those that are called like a number of the effect: the
/// polygons say only where it acts.
void tell_fields(const EffectEntry& entry, const std::string& path, const std::vector<std::string>& fields,
                 LoadedScenario& out) {
  out.notes.push_back(fields_note(path, {}, 0, fields));
  for (const EffectField& number : entry.fields()) {
    const std::string key(entry.key_of(number));
    if (std::ranges::find(fields, key) == fields.end()) continue;
    std::string way;
    if (entry.name == "forest-stems" && (key == "density" || key == "diameter"))
      way = "; for other stands in other polygons make a raster of it (gdal_rasterize -a " + key + ") and give " + key +
            " its name";
    out.warnings.push_back(path + ": the field '" + key + "' is not read: " + key + " of [effects." +
                           std::string(entry.name) + "] is that of the scenario in all polygons" + way);
  }
}

/// The cells whose centres the polygons of a file cover, as zones of ground are read.
Raster<std::uint8_t> read_mask(const EffectEntry& entry, const std::string& path, const Terrain& terrain,
                               LoadedScenario& out) {
  const std::string name(entry.name);
  const Grid& grid = terrain.heights.grid;
  Raster<std::uint8_t> mask(grid, 0, terrain.heights.values.memory());
  Layer layer("effects." + name, path, terrain);
  const std::string effect = "[effects." + name + "]";
  IdleFeatures idle(path, "polygons of " + effect, terrain);
  for_each_feature(layer, [&](const Feature& feature) {
    const Parts polygons = layer.polygons(*feature, ": " + effect + " acts inside");
    idle.mark(
        std::to_string(feature->GetFID()), polygons, [] { return std::uint8_t{1}; }, mask);
  });
  idle.warn(mask, out.warnings);
  tell_fields(entry, path, layer.field_names(), out);
  layer.tell(out);
  return mask;
}

/// Adds the forest of rasters or trees to the effect.
void load_forest(const std::map<std::string, NamedFile>& maps, const Terrain& terrain, Scenario& parts,
                 LoadedScenario& out) {
  const auto path = [&](const char* key) {
    const auto found = maps.find(key);
    return found == maps.end() ? std::string() : found->second.path;
  };
  ForestLayer layer =
      read_forest({path("density"), path("diameter"), path("trees")}, parts.effects.forest_stems, terrain);
  parts.effects.forest_stems = std::move(layer.forest);
  if (!layer.note.empty()) out.notes.push_back("forest-stems: " + layer.note);
  out.reprojections.insert(out.reprojections.end(), layer.reprojections.begin(), layer.reprojections.end());
  out.warnings.insert(out.warnings.end(), layer.warnings.begin(), layer.warnings.end());
}

}  // namespace

void load_effect_places(const ScenarioSpec& spec, const Terrain& terrain, Scenario& parts, LoadedScenario& out) {
  for (const EffectEntry& entry : effect_entries()) {
    const std::string name(entry.name);
    const auto found = spec.effects.find(name);
    EffectArea* area = entry.area(parts.effects);
    if (found == spec.effects.end() || area == nullptr) continue;
    const EffectSpec& effect = found->second;
    if (!effect.zones.empty()) {
      area->zones.assign(parts.zone_names.size(), 0);
      for (std::size_t i = 0; i < parts.zone_names.size(); ++i)
        area->zones[i] = std::count(effect.zones.begin(), effect.zones.end(), parts.zone_names[i]) > 0 ? 1 : 0;
    }
    if (!effect.file.path.empty()) area->mask = read_mask(entry, effect.file.path, terrain, out);
    if (!effect.maps.empty()) load_forest(effect.maps, terrain, parts, out);
  }
}

void tell_of_effects(LoadedScenario& out) {
  out.effects = effects_in_use(out.scenario);
  for (const EffectUse& use : out.effects) {
    if (!use.acts()) {
      out.warnings.push_back(use.idle);
      continue;
    }
    out.notes.push_back(use.text);
    for (std::string& warning : stand_warnings(*use.entry, out.scenario)) out.warnings.push_back(std::move(warning));
  }
  const auto of_days = [&](const EffectUse& use) { return use.entry->days(out.scenario.effects) != nullptr; };
  if (out.scenario.day != 0 && std::ranges::none_of(out.effects, of_days))
    out.warnings.push_back("day = " + std::to_string(out.scenario.day) +
                           " changes nothing: no effect that depends on the day is on; give [effects.wet-ground], or " +
                           "leave day out");
}

}  // namespace talus::io
