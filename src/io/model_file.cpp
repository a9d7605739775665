#include "talus/io/model_file.hpp"

#include <algorithm>
#include <sstream>

#include "scenario_spec.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/fields.hpp"
#include "talus/simulate/presets.hpp"

namespace talus::io {
namespace {

/// The tables [effects.*] of a model, as the reader of [effects.*] takes them; empty where none is on.
std::string effects_text(const Effects&) {
  return {};  // the reader takes none in this version
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
  if (!faults.empty()) throw InputError(faults.front());
  Model model;
  model.impact = spec.values.impact;
  model.effects = spec.values.effects;
  model.grounds.assign(campaign.zone_names.size(), spec.default_ground.ground);
  for (std::size_t i = 1; i < model.grounds.size(); ++i)
    for (const ZoneSpec& zone : spec.zones)
      if (zone.name == campaign.zone_names[i]) model.grounds[i] = zone.ground;
  return model;
}

std::string model_text(const Model& model, const LoadedCampaign& loaded, const std::string& heading) {
  std::string text;
  std::istringstream lines(heading);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  for (std::size_t i = 0; i < model.grounds.size(); ++i) {
    text += "\n[ground.zones." + toml_key(loaded.campaign.zone_names[i]) + "]\n";
    text += "preset = " + toml_text(std::string(kDefaultPreset)) + "\n";
    if (!loaded.zone_codes[i].empty()) text += "code = " + loaded.zone_codes[i] + "  # in a raster of zones\n";
    text += ground_text(model.grounds[i]);
  }
  text += "\n[model]\ndeformation_coefficient = " + text_of(model.impact.deformation_coefficient) + "\n";
  text += std::string("roughness = \"") + (model.impact.roughness == Roughness::Clamp ? "clamp" : "resample") + "\"\n";
  return text + effects_text(model.effects);
}

}  // namespace talus::io
