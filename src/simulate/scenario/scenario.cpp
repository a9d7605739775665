#include "talus/simulate/scenario/scenario.hpp"

#include <algorithm>

#include "effect_cells.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus {

namespace {

[[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& rule) {
  throw InputError(key + " = " + value + ": " + rule);
}

void check(const Bounds& bounds, double value, const std::string& key) {
  if (const auto fault = fault_of(bounds, value)) refuse(key, text_of(value), *fault);
}

std::string range_text(const Range& range) {
  return list_text({range.low, range.high});
}

void check(const Bounds& bounds, const Range& range, const std::string& key) {
  check(bounds, range.low, key);
  check(bounds, range.high, key);
  if (range.low > range.high) refuse(key, range_text(range), "must be [smallest, largest]");
}

void check_grounds(const Scenario& s) {
  const auto& grounds = s.cover.grounds;
  if (grounds.empty() || grounds.size() > 256)
    throw InputError("ground: " + std::to_string(grounds.size()) + " kinds of ground, must be 1 to 256");
  if (s.zone_names.size() != grounds.size())
    throw InputError("ground: " + std::to_string(s.zone_names.size()) + " names of zones for " +
                     std::to_string(grounds.size()) + " kinds of ground, must be equal");
  for (std::size_t i = 0; i < grounds.size(); ++i) {
    const std::string zone = i == 0 ? "ground.default." : "ground.zones." + s.zone_names[i] + ".";
    for (const auto& field : ground_fields()) check(field, field.get(grounds[i]), zone + std::string(field.key));
    const Range shape{grounds[i].shape_min, grounds[i].shape_max};
    if (shape.low > shape.high) refuse(zone + "shape", range_text(shape), "must be [smallest, largest]");
  }
  const Raster<std::uint8_t>& zones = s.cover.zones;
  if (zones.values.empty()) return;
  if (!(zones.grid == s.surface.grid()) || zones.values.size() != zones.grid.cells())
    throw InputError("ground: the zones are not on the grid of the DEM");
  int last = 0;
  for_each_row(zones, [&](int row) {
    const std::uint8_t* const first = &zones.at(0, row);
    last = std::max<int>(last, *std::max_element(first, first + zones.grid.columns));
  });
  if (last >= static_cast<int>(grounds.size()))
    throw InputError("ground: zone number " + std::to_string(last) + " has no parameters, must be below " +
                     std::to_string(grounds.size()));
}

void check_blocks(const Blocks& blocks) {
  const VolumePowerLaw& law = blocks.power_law;
  if (law.volume.high != 0.0) {
    if (!blocks.classes.empty()) throw InputError("blocks.diameter: has classes and a power law, must be either");
    check(bounds_of("blocks.volume_min"), law.volume.low, "blocks.diameter.volume_min");
    check(bounds_of("blocks.volume_max"), law.volume.high, "blocks.diameter.volume_max");
    if (law.volume.low > law.volume.high)
      refuse("blocks.diameter.volume_min", text_of(law.volume.low),
             "must not be above volume_max = " + text_of(law.volume.high));
    check(bounds_of("blocks.exponent"), law.exponent, "blocks.diameter.exponent");
  }
  std::size_t with_frequency = 0;
  for (const BlockClass& block : blocks.classes) {
    check(bounds_of("blocks.diameter"), block.diameter, "blocks.diameter");
    check(bounds_of("blocks.weight"), block.weight, "blocks.diameter.weight");
    if (std::isnan(block.frequency)) continue;
    check(bounds_of("blocks.frequency"), block.frequency, "blocks.diameter.frequency");
    ++with_frequency;
  }
  if (with_frequency != 0 && with_frequency != blocks.classes.size())
    throw InputError("blocks.diameter: " + std::to_string(with_frequency) + " of " +
                     std::to_string(blocks.classes.size()) + " classes have a frequency, must be all or none");
  for (int i = 0; i < 3; ++i) check(bounds_of("blocks.axes"), blocks.axes[i], "blocks.axes");
  if (blocks.axes[0] < blocks.axes[1] || blocks.axes[1] < blocks.axes[2])
    refuse("blocks.axes", list_text({blocks.axes[0], blocks.axes[1], blocks.axes[2]}), "must be L1 >= L2 >= L3");
}

void check_feature(const SourceFeature& f, const std::string& where) {
  if (!std::isnan(f.frequency)) check(bounds_of("sources.frequency"), f.frequency, where + "frequency");
  if (!std::isnan(f.diameter.low) || !std::isnan(f.diameter.high))
    check(bounds_of("blocks.diameter"), f.diameter, where + "diameter");
  check(bounds_of("sources.release_height"), f.release_height, where + "release_height");
  for (int axis = 0; axis < 3; ++axis)
    check(bounds_of("sources.velocity"), f.velocity[axis], where + (axis == 0 ? "vx" : axis == 1 ? "vy" : "vz"));
}

void check_sources(const Scenario& s) {
  if (s.sources.empty()) throw InputError("sources: no place of release, must be one at least");
  if (s.sources.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError("sources: " + std::to_string(s.sources.size()) + " places of release, must be less than 2^32");
  for (std::size_t i = 0; i < s.features.size(); ++i)
    check_feature(s.features[i], "sources: feature number " + std::to_string(i) + ": ");
  const bool sized = !s.blocks.classes.empty() || s.blocks.power_law.volume.high != 0.0;
  const Grid& grid = s.surface.grid();
  for (std::size_t i = 0; i < s.sources.size(); ++i) {
    const SourceCell& cell = s.sources[i];
    const std::string where = "sources: place number " + std::to_string(i);
    if (cell.feature >= s.features.size())
      throw InputError(where + " belongs to feature " + std::to_string(cell.feature) + ", which is not there");
    if (!(cell.x >= 0.0 && cell.y >= 0.0 && cell.x <= grid.width() && cell.y <= grid.height()))
      throw InputError(where + " lies off the terrain");
    if (!sized && std::isnan(s.features[cell.feature].diameter.low))
      throw InputError("blocks.diameter: feature number " + std::to_string(cell.feature) +
                       " of the sources has no diameter, and there is none for all");
  }
}

void check_thresholds(const std::vector<double>& values, const std::string& key) {
  if (values.empty() || values.size() > 32)
    throw InputError(key + ": has " + std::to_string(values.size()) + " values, must have 1 to 32");
  for (std::size_t i = 0; i < values.size(); ++i) {
    check(bounds_of(key), values[i], key);
    if (i > 0 && !(values[i] > values[i - 1]))
      throw InputError(key + ": " + text_of(values[i]) + " follows " + text_of(values[i - 1]) +
                       ", must ascend, each value once");
  }
}

/// Checks the lines of a screen or a barrier.
template <class Line>
void check_lines(const Line& of, const std::string& what) {
  for (const auto& line : of.lines)
    if (line.size() < 2 || !std::all_of(line.begin(), line.end(), [](const auto& p) { return p.allFinite(); }))
      throw InputError(what + ": '" + of.id + "' has a line without length, must have two places at least");
}

void check_barriers(const Barriers& barriers) {
  for (const Barrier& barrier : barriers.list()) {
    check_lines(barrier, "barriers");
    check(bounds_of("barriers.height"), barrier.height, "barriers: '" + barrier.id + "' height");
    check(bounds_of("barriers.capacity"), 1e-3 * barrier.capacity, "barriers: '" + barrier.id + "' capacity");
  }
}

void check_frequency(const Scenario& s) {
  const FrequencyRules& rules = s.frequency;
  if (!std::isnan(rules.total)) check(bounds_of("frequency.total"), rules.total, "frequency.total");
  if (!std::isnan(rules.per_area)) check(bounds_of("frequency.per_area"), rules.per_area, "frequency.per_area");
  if (!std::isnan(rules.scale)) check(bounds_of("frequency.power_law.A"), rules.scale, "frequency.power_law.A");
  if (!std::isnan(rules.scale)) check(bounds_of("frequency.power_law.b"), rules.exponent, "frequency.power_law.b");
  AnnualWeights::of(s);  // throws if frequencies contradict each other
}

void check_area(const Scenario& s, const EffectArea& where, const std::string& effect) {
  if (!where.zones.empty() && where.zones.size() != s.cover.grounds.size())
    throw InputError(effect + ": says of " + std::to_string(where.zones.size()) +
                     " zones whether it acts there, must be " + std::to_string(s.cover.grounds.size()));
  const Raster<std::uint8_t>& mask = where.mask;
  if (!mask.values.empty() && (!(mask.grid == s.surface.grid()) || mask.values.size() != mask.grid.cells()))
    throw InputError(effect + ": its mask is not on the grid of the DEM");
}

/// Refuses two effects that would take the energy of the same stand twice.
void check_stands(const Scenario& s) {
  const EffectEntry &drag = *find_effect("vegetation-drag"), &stems = *find_effect("forest-stems");
  if (s.drag_and_stems || !drag.acts(s.effects) || !stems.acts(s.effects)) return;
  const Grid& grid = s.surface.grid();
  const EffectCells with_drag(drag, s), with_stems(stems, s);
  with_drag.for_each([&](int column, int row) {
    if (with_stems.has(column, row))
      throw InputError(
          "effects: vegetation-drag and forest-stems act at the same place (the cell at " +
          with_decimals(grid.centre_x(column), 1) + " m, " + with_decimals(grid.centre_y(row), 1) +
          " m from the south-western corner), where the stand would take its energy twice: give them zones or files "
          "apart from each other, or set allow_both = true in [effects]");
  });
}

/// Checks that the map of a forest fits the terrain.
void check_forest(const Scenario& s) {
  const ForestStems& forest = s.effects.forest_stems;
  if (forest.map == nullptr) return;
  for (const Raster<float>* raster : {&forest.map->density, &forest.map->diameter})
    if (!raster->values.empty() &&
        (!(raster->grid == s.surface.grid()) || raster->values.size() != raster->grid.cells()))
      throw InputError("effects.forest-stems: its raster is not on the grid of the DEM");
  const Grid& grid = s.surface.grid();
  for (const Tree& tree : forest.map->trees.trees())
    if (!grid.contains(grid.column_of(tree.place.x()), grid.row_of(tree.place.y())) || !(tree.diameter > 0.0))
      throw InputError("effects.forest-stems: a tree stands off the terrain, or has no diameter");
}

void check_effects(Scenario& s) {
  for (const EffectEntry& entry : effect_entries()) {
    for (const EffectField& field : entry.fields())
      check(field, field.get(s.effects), "effects." + std::string(field.key));
    if (const EffectArea* where = entry.area(s.effects)) check_area(s, *where, "effects." + std::string(entry.name));
  }
  check_forest(s);
  check_stands(s);
}

}  // namespace

Scenario make_scenario(Scenario parts) {
  const Grid& grid = parts.surface.grid();
  if (grid.columns < 2 || grid.rows < 2 || parts.surface.heights().values.size() != grid.cells())
    throw InputError("dem: " + std::to_string(grid.columns) + " x " + std::to_string(grid.rows) +
                     " cells, must be at least 2 x 2");
  check(bounds_of("dem.cell"), grid.cell_x, "dem.cell");
  check(bounds_of("dem.cell"), grid.cell_y, "dem.cell");
  for (const auto& field : scenario_fields()) check(field, field.get(parts), std::string(field.key));
  check_grounds(parts);
  check_effects(parts);
  check_blocks(parts.blocks);
  check_sources(parts);
  check_thresholds(parts.output.energy_thresholds, "output.energy_thresholds");
  check_thresholds(parts.output.height_thresholds, "output.height_thresholds");
  for (const Screen& screen : parts.screens) check_lines(screen, "screens");
  check_barriers(parts.barriers);
  check_frequency(parts);
  return parts;
}

}  // namespace talus
