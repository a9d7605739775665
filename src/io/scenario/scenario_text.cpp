#include "scenario_text.hpp"

#include <algorithm>

#include "barrier_keys.hpp"
#include "fitted_on.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {

std::string toml_text(const std::string& text) {
  constexpr const char* kHex = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (byte < 0x20 || byte == 0x7F)
      out += std::string("\\u00") + kHex[byte >> 4] + kHex[byte & 0xF];
    else
      out += c;
  }
  return out + "\"";
}

std::string toml_key(const std::string& name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? name : toml_text(name);
}

namespace {

std::string range_text(const Range& range) {
  return range.low == range.high ? text_of(range.low) : list_text({range.low, range.high});
}

std::string diameter_text(const Blocks& blocks) {
  const VolumePowerLaw& law = blocks.power_law;
  if (law.volume.high != 0.0)
    return "{ volume_min = " + text_of(law.volume.low) + ", volume_max = " + text_of(law.volume.high) +
           ", exponent = " + text_of(law.exponent) + " }";
  if (blocks.classes.size() == 1 && blocks.classes[0].weight == 1.0 && std::isnan(blocks.classes[0].frequency))
    return range_text(blocks.classes[0].diameter);
  std::string text = "[";
  for (const BlockClass& block : blocks.classes)
    text += std::string(text.size() > 1 ? ", " : "") + "{ diameter = " + range_text(block.diameter) +
            ", weight = " + text_of(block.weight) +
            (std::isnan(block.frequency) ? "" : ", frequency = " + text_of(block.frequency)) + " }";
  return text + "]";
}

// One setting as the file has it.
struct Line {
  std::string table;  // "ground.zones.\"2\""; empty: at the top
  std::string key, value, unit, source;
  std::string full;      // "ground.zones.2.En50"
  bool is_text = false;  // the file has it in quotation marks
  bool written = true;   // in the file; a parameter that follows from a preset is written only in its zone
};

class Lines {
 public:
  explicit Lines(const ScenarioSpec& spec) : spec_(spec) {
    if (!spec.vrt_folders.empty()) add("", "vrt_folders", texts(spec.vrt_folders), "");
    file("", "dem", spec.dem);
    if (spec.profile) terrain(*spec.profile);
    if (!spec.dem.path.empty()) add_text("", "surface", std::string(name_of(spec.surface)));
    fields("");
    file("sources", "file", spec.sources);
    if (spec.profile) sources(*spec.profile);
    add("sources", "release_height", range_text(spec.release_height), "m");
    for (const auto& [name, field] : spec.source_fields) add_text("sources.fields", name, field.field);
    fields("blocks");
    const Blocks& blocks = spec.values.blocks;
    if (!blocks.classes.empty() || blocks.power_law.volume.high != 0.0)
      add("blocks", "diameter", diameter_text(blocks), blocks.power_law.volume.high != 0.0 ? "m3" : "m");
    add("blocks", "axes", list_text({blocks.axes[0], blocks.axes[1], blocks.axes[2]}), "");
    ground();
    fields("model");
    add_text("model", "roughness", spec.values.impact.roughness == Roughness::Clamp ? "clamp" : "resample");
    fields("output");
    if (spec.profile) {
      add("output", "bin", text_of(spec.profile->bin), "m");
      if (!spec.profile->screens.empty()) add("screens", "x", list_text(spec.profile->screens), "m");
    } else {
      add("output", "energy_thresholds", list_text(spec.values.output.energy_thresholds), "kJ");
      add("output", "height_thresholds", list_text(spec.values.output.height_thresholds), "m");
      add("output", "passages_below", text_of(spec.values.output.passages_below), "m");
      add("output", "energy_total", spec.values.output.energy_total ? "true" : "false", "");
      add("output", "count_rotation", spec.values.output.count_rotation ? "true" : "false", "");
      lines_.back().written = spec.values.output.count_rotation;  // the plans of earlier versions keep their checksum
      add("output", "bounds", spec.values.output.bounds ? "true" : "false", "");
      add_text("output", "vectors", std::string(name_of(spec.values.output.vectors)));
    }
    file("screens", "file", spec.screens);
    file("barriers", "file", spec.barriers);
    if (!spec.barrier_lines.empty()) add("barriers", "line", barrier_lines_text(spec.barrier_lines), "");
    frequency();
    effects();
    fit();
  }
  const std::vector<Line>& lines() const { return lines_; }

 private:
  void add(const std::string& table, const std::string& key, const std::string& value, const std::string& unit) {
    const std::string full = table.empty() ? key : table + "." + key;
    lines_.push_back({table, key, value, unit, spec_.origin(full), full});
  }

  void add_text(const std::string& table, const std::string& key, const std::string& text) {
    add(table, key, text, "");
    lines_.back().is_text = true;
  }

  static std::string texts(const std::vector<std::string>& list) {
    std::vector<std::string> quoted;
    for (const std::string& text : list) quoted.push_back(toml_text(text));
    return "[" + joined(quoted) + "]";
  }

  void file(const std::string& table, const std::string& key, const NamedFile& file) {
    if (!file.path.empty()) add_text(table, key, file.path);
  }

  void fields(const std::string& table) {
    for (const auto& field : scenario_fields()) {
      const std::string full(field.key);
      const auto dot = full.find('.');
      if ((dot == std::string::npos ? "" : full.substr(0, dot)) == table)
        add(table, full.substr(dot == std::string::npos ? 0 : dot + 1), text_of(field.get(spec_.values)),
            field.unit == "1" ? "" : std::string(field.unit));
    }
  }

  void terrain(const ProfileSpec& profile) {
    file("", "profile", profile.csv);
    file("", "line", profile.line);
    add("", "step", text_of(profile.step), "m");
  }

  void sources(const ProfileSpec& profile) {
    add("sources", "x", range_text(profile.source), "m");
    add("sources", "vx", text_of(profile.vx), "m/s");
    add("sources", "vz", text_of(profile.vz), "m/s");
  }

  void frequency() {
    const FrequencyRules& rules = spec_.values.frequency;
    if (rules.by_true_area) add("frequency", "by_true_area", "true", "");
    if (!std::isnan(rules.total)) add("frequency", "total", text_of(rules.total), "1/year");
    if (!std::isnan(rules.per_area)) add("frequency", "per_area", text_of(rules.per_area), "1/(m2 year)");
    if (!std::isnan(rules.scale))
      add("frequency", "power_law", "{ A = " + text_of(rules.scale) + ", b = " + text_of(rules.exponent) + " }",
          "1/year");
  }

  void effects() {
    if (spec_.effects.empty()) return;
    add("effects", "allow_both", spec_.values.drag_and_stems ? "true" : "false", "");
    for (const EffectEntry& entry : effect_entries()) {
      const auto found = spec_.effects.find(std::string(entry.name));
      if (found == spec_.effects.end()) continue;
      const std::string table = "effects." + found->first;
      effect_numbers(entry, found->second, table);
      if (const std::vector<int>* days = entry.days(spec_.values.effects))
        add(table, "days", list_text({days->begin(), days->end()}), "");
      std::vector<std::string> zones;
      for (const std::string& zone : found->second.zones) zones.push_back(toml_text(zone));
      if (!zones.empty()) add(table, "zones", std::string("[") + joined(zones) + "]", "");
      file(table, "file", found->second.file);
    }
  }

  /// The numbers of an effect, or the rasters or the trees in place of them.
  void effect_numbers(const EffectEntry& entry, const EffectSpec& effect, const std::string& table) {
    const auto trees = effect.maps.find("trees");
    if (trees != effect.maps.end()) file(table, "trees", trees->second);
    for (const EffectField& field : entry.fields()) {
      const std::string key(entry.key_of(field));
      const auto raster = effect.maps.find(key);
      if (raster != effect.maps.end())
        file(table, key, raster->second);
      else if (!field.by_cell || trees == effect.maps.end())
        add(table, key, text_of(field.get(spec_.values.effects)), field.unit == "1" ? "" : std::string(field.unit));
    }
  }

  /// Facts on the fit of the ground, [fit]. With them a run of the written scenario gives the same warnings.
  void fit() {
    const FittedOn& fitted = spec_.fitted_on;
    if (fitted.file.path.empty()) return;
    const auto line = [&](const char* key, const std::string& value, const char* unit = "", bool is_text = false) {
      lines_.push_back({"fit", key, value, unit, spec_.origin("fit"), std::string("fit.") + key, is_text});
    };
    line("file", fitted.file.path, "", true);
    if (!fitted.sha256.empty()) line("sha256", fitted.sha256, "", true);
    if (fitted.surface) line("surface", std::string(name_of(*fitted.surface)), "", true);
    if (fitted.cell) line("fitted_cell", text_of(*fitted.cell), "m");
    if (fitted.diameters) line("fitted_diameters", list_text({fitted.diameters->low, fitted.diameters->high}), "m");
    if (fitted.skill) line("fitted_skill", skill_list(*fitted.skill));
    if (fitted.deformation_coefficient) line("deformation_coefficient", text_of(*fitted.deformation_coefficient));
    fitted_numbers(spec_.default_ground);
    for (const ZoneSpec& zone : spec_.zones) fitted_numbers(zone);
  }

  void fitted_numbers(const ZoneSpec& zone) {
    std::vector<std::string> keys;
    for (const auto& [key, origin] : zone.own)
      if (is_of_fit(spec_, zone, key)) keys.push_back(key);
    if (!keys.empty())
      lines_.push_back(
          {"fit.zones", toml_key(zone.name), texts(keys), "", spec_.origin("fit"), kFittedNumbers + zone.name});
  }

  void ground() {
    file("ground", "file", spec_.ground);
    if (!spec_.ground_field.empty()) add_text("ground", "field", spec_.ground_field);
    add_text("ground", "default", spec_.default_ground.preset);
    if (const std::string& code = spec_.default_ground.code; !code.empty())
      lines_.push_back({"ground.zones.default", "code", code, "", "scenario", "ground.default.code"});
    parameters(spec_.default_ground, "ground.zones.default", "ground.default.", !spec_.default_ground.own.empty());
    for (const ZoneSpec& zone : spec_.zones) {
      const std::string table = "ground.zones." + toml_key(zone.name), full = "ground.zones." + zone.name + ".";
      const std::string origin = spec_.origin(full + "preset");
      lines_.push_back({table, "preset", zone.preset, "", origin == "default" ? "preset of [ground] default" : origin,
                        full + "preset", true});
      if (!zone.intervals.empty()) {
        std::vector<std::string> words;
        for (const Range& x : zone.intervals) words.push_back(list_text({x.low, x.high}));
        lines_.push_back({table, "x", std::string("[") + joined(words) + "]", "m", "scenario", full + "x"});
      }
      if (!zone.code.empty()) lines_.push_back({table, "code", zone.code, "", "scenario", full + "code"});
      parameters(zone, table, full, true);
    }
  }

  void parameters(const ZoneSpec& zone, const std::string& table, const std::string& full, bool written) {
    const auto source = [&](const std::string& key) {
      const auto own = zone.own.find(key);
      return own == zone.own.end() ? "preset " + zone.preset : own->second;
    };
    for (const auto& field : ground_fields()) {
      const std::string key(field.key);
      if (key == "shape_min" || key == "shape_max") continue;
      lines_.push_back({table, key, text_of(field.get(zone.ground)), field.unit == "1" ? "" : std::string(field.unit),
                        source(key), full + key, false, written});
    }
    lines_.push_back({table, "shape", list_text({zone.ground.shape_min, zone.ground.shape_max}), "", source("shape"),
                      full + "shape", false, written});
  }

  const ScenarioSpec& spec_;
  std::vector<Line> lines_;
};

}  // namespace

std::string toml_of(const ScenarioSpec& spec) {
  std::string text = std::string("# A complete ") + (spec.profile ? "profile" : "scenario") +
                     ", written by Talus: every setting of the run.\n",
              table;
  const Lines lines(spec);
  for (const Line& line : lines.lines()) {
    if (!line.written) continue;
    if (line.table != table) {
      text += "\n[" + line.table + "]\n";
      table = line.table;
    }
    text += line.key + " = " + (line.is_text ? toml_text(line.value) : line.value);
    if (!line.unit.empty()) text += "  # " + line.unit;
    text += "\n";
  }
  return text;
}

std::vector<Setting> settings_of(const ScenarioSpec& spec) {
  std::vector<Setting> settings;
  const Lines lines(spec);
  for (const Line& line : lines.lines()) settings.push_back({line.full, line.value, line.unit, line.source});
  return settings;
}

}  // namespace talus::io
