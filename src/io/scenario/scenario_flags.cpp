#include "scenario_flags.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "effect_keys.hpp"
#include "io/gdal/csv_table.hpp"
#include "named_file.hpp"
#include "scenario_keys.hpp"
#include "surface_key.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/layer_name.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {

namespace {

void lay_flag(ScenarioSpec& spec, const std::string& key, const std::string& name, double value,
              std::vector<std::string>& faults) {
  const std::string flag = "flag " + name;
  for (const auto& field : scenario_fields()) {
    if (field.key != key) continue;
    if (const auto rule = fault_of(field, value)) {
      faults.push_back(flag + " = " + text_of(value) + ": " + *rule);
      continue;
    }
    field.set(spec.values, value);
    spec.origins[key] = flag;
  }
}

/// A flag that names a file, in place of that of the scenario.
void lay_file(ScenarioSpec& spec, const std::string& flag, const std::optional<std::string>& path, NamedFile& file,
              const char* key) {
  if (!path) return;
  file = {absolute_path(*path, std::filesystem::current_path()), "flag " + flag + " = '" + *path + "'"};
  spec.origins[key] = "flag " + flag;
}

/// Why the scenario of a run cannot hold the name of a field; empty: it can.
std::string fault_of_field_name(const std::string& field) {
  return fault_of_encoding(field, "the name of the field",
                           "save the file in UTF-8 (or rename the field), and give the name in UTF-8");
}

/// --field NAME=COLUMN, which overrides the same name of [sources.fields].
void lay_fields(ScenarioSpec& spec, const std::vector<std::string>& flags, std::vector<std::string>& faults) {
  FieldMap given;
  for (const std::string& flag : flags) {
    const std::string where = "flag --field " + flag;
    const std::size_t equals = flag.find('=');
    const std::string name = flag.substr(0, equals);
    const std::vector<std::string>& names = source_field_names();
    if (equals == std::string::npos)
      faults.push_back(where + ": must be NAME=COLUMN, for example release_height=HEIGHT, or NAME= for none (names: " +
                       joined(names) + ")");
    else if (std::ranges::find(names, name) == names.end())
      faults.push_back(where + ": unknown name '" + name + "'" + known_names(name, names));
    else if (const std::string fault = fault_of_field_name(flag.substr(equals + 1)); !fault.empty())
      faults.push_back(where + ": " + fault);
    else if (!given.insert({name, {flag.substr(equals + 1), where}}).second)
      faults.push_back(where + ": " + name + " is given twice, must be once");
  }
  for (auto& [name, field] : given) {
    spec.source_fields[name] = field;
    spec.origins["sources.fields." + name] = "flag --field";
  }
}

/// The parts of texts between semicolons.
std::vector<std::string> parts_of(const std::vector<std::string>& texts) {
  std::vector<std::string> parts;
  for (const std::string& text : texts)
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t to = std::min(text.find(';', from), text.size());
      if (std::string part = trimmed(text.substr(from, to - from)); !part.empty()) parts.push_back(std::move(part));
      from = to + 1;
    }
  return parts;
}

/// Places and maps of an effect that flags have taken away.
std::vector<std::string> taken_away(const EffectSpec& before, const EffectSpec& after) {
  std::vector<std::string> lost;
  if (!before.zones.empty() && after.zones.empty()) lost.emplace_back("zones");
  if (!before.file.path.empty() && after.file.path.empty()) lost.emplace_back("file");
  for (const auto& [key, map] : before.maps)
    if (!after.maps.contains(key)) lost.push_back(key);
  return lost;
}

/// --effect NAME.KEY=VALUE, laid over [effects].
void lay_effects(ScenarioSpec& spec, const std::vector<std::string>& flags, std::vector<std::string>& faults) {
  TomlValue effects;
  for (const std::string& flag : parts_of(flags)) {
    const std::string where = "flag --effect " + flag;
    const std::size_t equals = flag.find('='), dot = flag.find('.');
    if (equals == std::string::npos || dot > equals) {
      faults.push_back(where + ": must be NAME.KEY=VALUE, for example block-mass.preset=measured (docs/effects.md)");
      continue;
    }
    const std::string name = trimmed(flag.substr(0, dot)), key = trimmed(flag.substr(dot + 1, equals - dot - 1));
    auto effect = std::ranges::find(effects.members, name, &TomlMember::key);
    if (effect == effects.members.end()) effect = effects.members.insert(effect, {name, {}});
    if (effect->value.find(key) != nullptr)
      faults.push_back(where + ": " + name + "." + key + " is given twice, must be once");
    else
      effect->value.members.push_back({key, toml_value(trimmed(flag.substr(equals + 1)))});
  }
  if (effects.members.empty()) return;
  const std::map<std::string, EffectSpec> before = spec.effects;
  read_effects(spec, {&effects, "effects", "flag --effect", faults}, std::filesystem::current_path(), "flag --effect");
  for (const auto& [name, effect] : before) {
    const std::vector<std::string> lost = taken_away(effect, spec.effects[name]);
    if (!lost.empty())
      spec.warnings.push_back("flag --effect: takes the place of " + joined(lost) + " of [effects." + name + "]");
  }
}

/// --sources-layer NAME: the layer of the file of sources, also of one that the scenario names.
void lay_sources_layer(ScenarioSpec& spec, const std::string& layer, std::vector<std::string>& faults) {
  if (spec.sources.path.empty()) {
    faults.push_back("flag --sources-layer = '" + layer +
                     "': must come with --sources, or a scenario that has sources");
    return;
  }
  if (const std::string file = file_of_layer(spec.sources.path); file != spec.sources.path)
    faults.push_back("flag --sources-layer = '" + layer + "': the name of the file has a layer already: " +
                     spec.sources.path.substr(file.size()) + "; give one of the two");
  spec.sources.path += "|layername=" + layer;
  spec.origins["sources.file"] += ", flag --sources-layer";
}

/// Flags of [output] that name no number.
void lay_output(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults) {
  if (flags.energy_total) {
    spec.values.output.energy_total = true;
    spec.origins["output.energy_total"] = "flag --energy-total";
  }
  if (flags.count_rotation) {
    spec.values.output.count_rotation = true;
    spec.origins["output.count_rotation"] = "flag --count-rotation";
  }
  if (flags.bounds) {
    spec.values.output.bounds = true;
    spec.origins["output.bounds"] = "flag --bounds";
  }
  if (flags.vectors) {
    const auto format = vector_format(*flags.vectors);
    if (!format) faults.push_back("flag --vectors = '" + *flags.vectors + "': " + kVectorsRule);
    spec.values.output.vectors = format.value_or(VectorFormat::GeoPackage);
    spec.origins["output.vectors"] = "flag --vectors";
  }
}

/// --diameter M, in place of all blocks of the scenario.
void lay_diameter(ScenarioSpec& spec, double diameter, bool has_frequency, std::vector<std::string>& faults) {
  if (const auto rule = fault_of(bounds_of("blocks.diameter"), diameter))
    faults.push_back("flag --diameter = " + text_of(diameter) + ": " + *rule);
  double frequency = 0.0;
  for (const BlockClass& block : spec.values.blocks.classes)
    if (!std::isnan(block.frequency)) frequency += block.frequency;
  if (frequency > 0.0)
    spec.warnings.push_back(
        "flag --diameter = " + text_of(diameter) +
        ": takes the place of the block classes of the scenario, and their " + with_digits(frequency, 4) +
        " events per year are dropped with them" +
        (has_frequency
             ? ""
             : "; unless the sources or [frequency] say how often blocks fall, give --frequency for a hazard"));
  spec.values.blocks.power_law = {};
  spec.values.blocks.classes = {BlockClass{{diameter, diameter}}};
  spec.origins["blocks.diameter"] = "flag --diameter";
}

}  // namespace

void start_with_preset(ScenarioSpec& spec, const RunFlags& flags, std::string_view standard,
                       std::vector<std::string>& faults) {
  spec.default_ground = {"default", std::string(standard), find_preset(standard).ground, {}, {}, {}};
  if (!flags.preset) return;
  try {
    spec.default_ground.ground = find_preset(*flags.preset).ground;
    spec.default_ground.preset = *flags.preset;
    spec.origins["ground.default"] = kPresetFlag;
  } catch (const InputError& error) {
    faults.push_back("flag --preset = '" + *flags.preset + "': " + error.what());
  }
}

void warn_of_unused_preset(const ScenarioSpec& spec, std::vector<std::string>& warnings) {
  const std::size_t unused = spec.profile ? 1 : 0;  // psi_scale, which a profile does not have
  if (spec.origin("ground.default") != kPresetFlag || !spec.default_ground.gives_all(unused)) return;
  warnings.push_back("flag --preset = '" + spec.default_ground.preset + "' changes nothing: " + spec.scenario.where +
                     " gives every number of the default ground, which counts more: take out its "
                     "[ground.zones.default], or leave the flag out");
}

void start_with_model(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults) {
  if (!flags.parameters) return;
  const std::string flag = "flag --parameters = '" + *flags.parameters + "'";
  if (!flags.scenario.empty())
    faults.push_back(flag + ": a scenario names its model itself: include = \"FILE\" at its top");
  if (flags.preset) faults.push_back(flag + ": must not come with --preset; leave out one of the two");
  if (!flags.scenario.empty() || flags.preset) return;
  spec.include = {absolute_path(*flags.parameters, std::filesystem::current_path()), flag};
  std::error_code none;
  if (!std::filesystem::exists(spec.include.path, none)) return;  // reported later, with the other files
  read_model_keys(spec, spec.include.path, *flags.parameters, "flag --parameters", faults);
}

void lay_flags(ScenarioSpec& spec, const RunFlags& flags, std::vector<std::string>& faults) {
  lay_file(spec, "--dem", flags.dem, spec.dem, "dem");
  lay_file(spec, "--sources", flags.sources, spec.sources, "sources.file");
  if (flags.sources_layer) lay_sources_layer(spec, *flags.sources_layer, faults);
  lay_file(spec, "--screens", flags.screens, spec.screens, "screens.file");
  lay_file(spec, "--barriers", flags.barriers, spec.barriers, "barriers.file");
  lay_file(spec, "--zones", flags.zones, spec.ground, "ground.file");
  if (flags.zone_field) {
    if (spec.ground.path.empty())
      faults.push_back("flag --zone-field = '" + *flags.zone_field +
                       "': must come with --zones, or a scenario that has zones");
    if (const std::string fault = fault_of_field_name(*flags.zone_field); !fault.empty())
      faults.push_back("flag --zone-field = '" + *flags.zone_field + "': " + fault);
    spec.ground_field = *flags.zone_field;
    spec.origins["ground.field"] = "flag --zone-field";
  }
  lay_fields(spec, flags.fields, faults);
  lay_effects(spec, flags.effects, faults);
  if (flags.surface)
    if (const auto kind = surface_of_flag(*flags.surface, faults)) {
      spec.surface = *kind;
      spec.origins["surface"] = "flag --surface";
    }
  if (flags.trajectories) lay_flag(spec, "trajectories", "--trajectories", *flags.trajectories, faults);
  if (flags.seed) lay_flag(spec, "seed", "--seed", static_cast<double>(*flags.seed), faults);
  if (flags.deformation_coefficient)
    lay_flag(spec, "model.deformation_coefficient", "--deformation-coefficient", *flags.deformation_coefficient,
             faults);
  lay_output(spec, flags, faults);
  if (flags.frequency) {
    spec.values.frequency.total = *flags.frequency;
    spec.origins["frequency.total"] = "flag --frequency";
    if (const auto rule = fault_of(bounds_of("frequency.total"), *flags.frequency))
      faults.push_back("flag --frequency = " + text_of(*flags.frequency) + ": " + *rule);
  }
  if (!flags.thresholds.empty()) {
    spec.values.output.energy_thresholds = flags.thresholds;
    spec.origins["output.energy_thresholds"] = "flag --thresholds";
    if (std::ranges::adjacent_find(flags.thresholds, std::greater_equal<>()) != flags.thresholds.end())
      faults.push_back("flag --thresholds = " + list_text(flags.thresholds) + ": must ascend, as 30,300");
  }
  if (flags.diameter) lay_diameter(spec, *flags.diameter, flags.frequency.has_value(), faults);
}

}  // namespace talus::io
