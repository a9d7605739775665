#include "talus/io/campaign/model_file.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/scenario/scenario_spec.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {
namespace {

bool is_on(const Effects& effects, std::string_view name) {
  for (const auto& field : effect_fields())
    if (field.key.starts_with(std::string(name) + ".") && !std::isnan(field.off) && field.get(effects) != field.off)
      return true;
  return false;
}

/// `zones = ["meadow"]`, where an effect does not act in all zones of the campaign.
std::string zones_text(const EffectArea* extent, const Campaign& campaign) {
  if (extent == nullptr || extent->zones.empty()) return {};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < campaign.zone_names.size(); ++i)
    if (extent->zones[i] != 0) names.push_back(toml_text(campaign.zone_names[i]));
  return "zones = [" + joined(names) + "]\n";
}

/// The tables [effects.*] of a model, as the reader of [effects.*] takes them; empty where none is on.
std::string effects_text(Effects effects, const Campaign& campaign) {
  std::string text;
  if (is_on(effects, "vegetation-drag") && is_on(effects, "forest-stems"))  // found one after the other
    text += "\n[effects]\nallow_both = true\n";
  for (const std::string_view name : effect_names()) {
    if (!is_on(effects, name)) continue;
    text += "\n[effects." + std::string(name) + "]\n";
    for (const auto& field : effect_fields()) {
      if (!field.key.starts_with(std::string(name) + ".")) continue;
      text += std::string(field.key.substr(name.size() + 1)) + " = " + text_of(field.get(effects));
      text += field.unit == "1" ? "\n" : "  # " + std::string(field.unit) + "\n";
    }
    if (name == "wet-ground") {
      std::vector<std::string> days;
      for (const int day : effects.wet_ground.days) days.push_back(std::to_string(day));
      text += "days = [" + joined(days) + "]\n";
    }
    text += zones_text(extent_of(effects, name), campaign);
  }
  return text;
}

/// Bands, barriers and biases as comments: no scenario can read them.
std::string anomalies_text(const Model& model) {
  std::string text;
  for (const Net& net : model.nets)
    text += "\n# undeclared-barrier: " + text_of(net.height) + " m high, from (" + text_of(net.line.front().x()) +
            ", " + text_of(net.line.front().y()) + ") to (" + text_of(net.line.back().x()) + ", " +
            text_of(net.line.back().y()) + ") m from the lower left corner of the DEM\n";
  for (std::size_t i = 0; i < model.bias.size(); ++i)
    if (const Bias& b = model.bias[i]; b.speed != 0.0 || b.jump != 0.0 || b.spin != 0.0)
      text += "\n# instrument-bias: instrument " + std::to_string(i + 1) + " reads speed " + text_of(b.speed) +
              ", jump " + text_of(b.jump) + ", spin " + text_of(b.spin) + " too high (share of the value)\n";
  if (!model.zones.values.empty())
    text +=
        "\n# undeclared-zone: a band of other ground, see diagnosis.json; the ground in it is not part of this file\n";
  return text;
}

std::string ground_text(const Ground& ground) {
  std::string text;
  for (const auto& field : ground_fields()) {
    if (field.key == "shape_min" || field.key == "shape_max") continue;
    text += std::string(field.key) + " = " + text_of(field.get(ground));
    if (field.unit != "1") text += "  # " + std::string(field.unit);
    text += "\n";
  }
  return text + "shape = [" + text_of(ground.shape_min) + ", " + text_of(ground.shape_max) + "]\n";
}

/// A model for a campaign acts in the campaign's zones only.
void check_places(const std::string& name, const EffectSpec& effect, const Campaign& campaign, const std::string& path,
                  std::vector<std::string>& faults) {
  if (!effect.file.path.empty())
    faults.push_back(path + ": [effects." + name + "] file = \"" + effect.file.path +
                     "\": a campaign knows only its own zones: name them by zones = [...]");
  const std::string unknown = path + ": [effects." + name + "] zones: the campaign has no such zone";
  for (const std::string& zone : effect.zones)
    if (std::find(campaign.zone_names.begin(), campaign.zone_names.end(), zone) == campaign.zone_names.end())
      faults.push_back(unknown + known_names(zone, campaign.zone_names));
}

}  // namespace

Model read_model(const std::string& path, const Campaign& campaign) {
  ScenarioSpec spec;
  std::vector<std::string> faults;
  start_with_preset(spec, {}, faults);
  read_model_keys(spec, path, path, path, faults);
  for (const ZoneSpec& zone : spec.zones)
    if (std::find(campaign.zone_names.begin(), campaign.zone_names.end(), zone.name) == campaign.zone_names.end())
      faults.push_back(path + ": [ground.zones." + toml_key(zone.name) + "]: the campaign has no such zone" +
                       known_names(zone.name, campaign.zone_names));
  for (const auto& [name, effect] : spec.effects) check_places(name, effect, campaign, path, faults);
  if (!faults.empty()) throw InputError(faults.front());
  Model model;
  model.impact = spec.values.impact;
  model.effects = spec.values.effects;
  model.grounds.assign(campaign.zone_names.size(), spec.default_ground.ground);
  for (std::size_t i = 1; i < model.grounds.size(); ++i)
    for (const ZoneSpec& zone : spec.zones)
      if (zone.name == campaign.zone_names[i]) model.grounds[i] = zone.ground;
  for (const auto& [name, effect] : spec.effects) {
    EffectArea* extent = extent_of(model.effects, name);
    if (extent == nullptr || effect.zones.empty()) continue;
    for (const std::string& zone : campaign.zone_names)
      extent->zones.push_back(std::count(effect.zones.begin(), effect.zones.end(), zone) > 0 ? 1 : 0);
  }
  return model;
}

std::string model_text(const Model& model, const LoadedCampaign& loaded, const std::string& heading) {
  std::string text;
  std::istringstream lines(heading);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  for (std::size_t i = 0; i < loaded.campaign.zone_names.size(); ++i) {
    text += "\n[ground.zones." + toml_key(loaded.campaign.zone_names[i]) + "]\n";
    text += "preset = " + toml_text(std::string(kDefaultPreset)) + "\n";
    if (!loaded.zone_codes[i].empty()) text += "code = " + loaded.zone_codes[i] + "  # in a raster of zones\n";
    text += ground_text(model.grounds[i]);
  }
  text += "\n[model]\ndeformation_coefficient = " + text_of(model.impact.deformation_coefficient) + "\n";
  text += std::string("roughness = \"") + (model.impact.roughness == Roughness::Clamp ? "clamp" : "resample") + "\"\n";
  return text + effects_text(model.effects, loaded.campaign) + anomalies_text(model);
}

}  // namespace talus::io
