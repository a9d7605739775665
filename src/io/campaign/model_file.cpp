#include "talus/io/campaign/model_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "io/files/checksum.hpp"
#include "io/scenario/barrier_keys.hpp"
#include "io/scenario/fitted_on.hpp"
#include "io/scenario/scenario_flags.hpp"
#include "io/scenario/scenario_keys.hpp"
#include "io/scenario/scenario_text.hpp"
#include "talus/base/error.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {
namespace {

/// `zones = ["meadow"]`; empty for an effect that acts in all zones of the campaign.
std::string zones_text(const EffectArea* area, const Campaign& campaign) {
  if (area == nullptr || area->zones.empty()) return {};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < campaign.zone_names.size(); ++i)
    if (area->zones[i] != 0) names.push_back(toml_text(campaign.zone_names[i]));
  return "zones = [" + joined(names) + "]\n";
}

/// The tables [effects.*] of a model, as the reader of [effects.*] takes them; empty if none is on.
std::string effects_text(const Effects& effects, const Campaign& campaign) {
  std::string text;
  if (find_effect("vegetation-drag")->acts(effects) &&
      find_effect("forest-stems")->acts(effects))  // else a scenario refuses them at one place
    text += "\n[effects]\nallow_both = true\n";
  for (const EffectEntry& entry : effect_entries()) {
    if (!entry.acts(effects)) continue;
    text += "\n[effects." + std::string(entry.name) + "]\n";
    for (const EffectField& field : entry.fields()) {
      text += std::string(entry.key_of(field)) + " = " + text_of(field.get(effects));
      text += field.unit == "1" ? "\n" : "  # " + std::string(field.unit) + "\n";
    }
    if (const std::vector<int>* days = entry.days(effects)) {
      std::vector<std::string> words;
      for (const int day : *days) words.push_back(std::to_string(day));
      text += "days = [" + joined(words) + "]\n";
    }
    text += zones_text(entry.area(effects), campaign);
  }
  return text;
}

/// [barriers] of a model, in the coordinates of the DEM.
std::string barriers_text(const Model& model, const Campaign& campaign) {
  std::vector<BarrierLine> lines;
  for (const Barrier& barrier : model.barriers) lines.push_back(line_of(barrier, campaign.surface.grid()));
  return lines.empty() ? "" : "\n[barriers]\nline = " + barrier_lines_text(lines) + "  # m, kJ\n";
}

/// [[instrument_bias]] of a model: `talus score` uses it, a scenario warns that it does not.
std::string bias_text(const Model& model, const Campaign& campaign) {
  std::string text;
  const auto add = [&](std::size_t instrument, const std::string& screen) {
    if (instrument >= model.bias.size()) return;
    const Bias& b = model.bias[instrument];
    if (b.speed == 0.0 && b.jump == 0.0 && b.spin == 0.0) return;
    text += "\n[[instrument_bias]]  # read too high, as a share of the value\n" + screen;
    text += "speed = " + text_of(b.speed) + "\njump = " + text_of(b.jump) + "\nspin = " + text_of(b.spin) + "\n";
  };
  for (std::size_t s = 0; s < campaign.screens.size(); ++s)
    add(instrument_of_screen(s), "screen = " + toml_text(campaign.screens[s].id) + "\n");
  add(kSampler, "");
  return text;
}

/// A note about a band of other ground, which no file can hold: it has no name and no polygon.
std::string band_text(const Model& model) {
  if (model.zones.values.empty()) return {};
  return "\n# undeclared-zone: a band of other ground, see diagnosis.json; the ground in it is not part of this file\n";
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

/// Equivalent diameters of the fitting rows, of all blocks if there are none [m].
Range fitted_diameters(const Campaign& campaign) {
  const bool all = std::ranges::all_of(campaign.blocks, &MeasuredBlock::holdout);
  Range sizes{std::numeric_limits<double>::infinity(), 0.0};
  for (const MeasuredBlock& block : campaign.blocks) {
    if (block.holdout && !all) continue;
    const double diameter = equivalent_diameter(block.mass, block.density);
    sizes = {std::min(sizes.low, diameter), std::max(sizes.high, diameter)};
  }
  return sizes;
}

/// Adds a fault for an effect that acts outside the zones of the campaign.
void check_places(const std::string& name, const EffectSpec& effect, const Campaign& campaign, const std::string& path,
                  std::vector<std::string>& faults) {
  if (!effect.file.path.empty())
    faults.push_back(path + ": [effects." + name + "] file = \"" + effect.file.path +
                     "\": a campaign knows only its own zones: name them by zones = [...]");
  for (const auto& [key, map] : effect.maps)
    faults.push_back(path + ": [effects." + name + "] " + key + " = \"" + map.path +
                     "\": a campaign takes no map of a forest: give numbers");
  const std::string unknown = path + ": [effects." + name + "] zones: the campaign has no such zone";
  for (const std::string& zone : effect.zones)
    if (std::find(campaign.zone_names.begin(), campaign.zone_names.end(), zone) == campaign.zone_names.end())
      faults.push_back(unknown + known_names(zone, campaign.zone_names));
}

/// Number of the instrument of a bias: a screen, or the samples.
std::size_t instrument_of(const InstrumentBias& bias, const Campaign& campaign) {
  if (bias.screen.empty()) return kSampler;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < campaign.screens.size(); ++i) {
    if (campaign.screens[i].id == bias.screen) return instrument_of_screen(i);
    known.push_back(campaign.screens[i].id);
  }
  throw InputError(bias.where + " screen = '" + bias.screen + "': the campaign has no such screen" +
                   known_names(bias.screen, known));
}

/// Says which zones of the campaign a model leaves to the default ground although it describes others.
void warn_of_undescribed_zones(const ScenarioSpec& spec, const Campaign& campaign, const std::string& path,
                               std::vector<std::string>& warnings) {
  if (spec.zones.empty()) return;
  std::vector<std::string> left;
  for (std::size_t i = 1; i < campaign.zone_names.size(); ++i)
    if (std::ranges::find(spec.zones, campaign.zone_names[i], &ZoneSpec::name) == spec.zones.end())
      left.push_back(campaign.zone_names[i]);
  if (!left.empty())
    warnings.push_back(path + ": does not describe the zones " + joined(left) + " of the campaign: they have the " +
                       "default ground (" + spec.default_ground.preset + "); if they must not, give [ground.zones." +
                       toml_key(left.front()) + "]");
}

}  // namespace

InputFile model_input(const std::string& path) {
  return recorded_input("model", std::filesystem::absolute(path).lexically_normal().string());
}

Model read_model(const std::string& path, const Campaign& campaign, std::vector<std::string>* warnings) {
  ScenarioSpec spec;
  std::vector<std::string> faults;
  start_with_preset(spec, {}, kDefaultPreset, faults);
  read_model_keys(spec, path, path, path, faults);
  for (const ZoneSpec& zone : spec.zones)
    if (std::find(campaign.zone_names.begin(), campaign.zone_names.end(), zone.name) == campaign.zone_names.end())
      faults.push_back(path + ": [ground.zones." + toml_key(zone.name) + "]: the campaign has no such zone" +
                       known_names(zone.name, campaign.zone_names));
  for (const auto& [name, effect] : spec.effects) check_places(name, effect, campaign, path, faults);
  if (!faults.empty()) throw InputFaults(faults, faults.size());
  const SurfaceKind kind = campaign.surface.kind();
  if (warnings != nullptr) {
    warnings->insert(warnings->end(), spec.warnings.begin(), spec.warnings.end());
    warn_of_undescribed_zones(spec, campaign, path, *warnings);
    warn_of_other_terrain(
        spec, campaign.surface.grid(), kind, path, "the campaign is simulated",
        ": give --surface " + std::string(name_of(spec.fitted_on.surface.value_or(kind))) + ", or fit again",
        *warnings);
  }
  Model model;
  model.impact = spec.values.impact;
  model.effects = spec.values.effects;
  model.grounds.assign(campaign.zone_names.size(), spec.default_ground.ground);
  for (std::size_t i = 1; i < model.grounds.size(); ++i)
    for (const ZoneSpec& zone : spec.zones)
      if (zone.name == campaign.zone_names[i]) model.grounds[i] = zone.ground;
  for (const auto& [name, effect] : spec.effects) {
    EffectArea* area = find_effect(name)->area(model.effects);
    if (area == nullptr || effect.zones.empty()) continue;
    for (const std::string& zone : campaign.zone_names)
      area->zones.push_back(std::count(effect.zones.begin(), effect.zones.end(), zone) > 0 ? 1 : 0);
  }
  for (const BarrierLine& line : spec.barrier_lines)
    model.barriers.push_back(barrier_of(line, campaign.surface.grid()));
  if (!spec.instrument_bias.empty()) model.bias.resize(instrument_of_screen(campaign.screens.size()));
  for (const InstrumentBias& bias : spec.instrument_bias)
    model.bias[instrument_of(bias, campaign)] = {bias.speed, bias.jump, bias.spin};
  return model;
}

std::string model_text(const Model& model, const LoadedCampaign& loaded, const std::string& heading,
                       const Reduction& skill) {
  std::string text;
  std::istringstream lines(heading);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  text += "\nsurface = " + toml_text(std::string(name_of(loaded.campaign.surface.kind()))) + "\n";
  text += "fitted_cell = " + text_of(loaded.campaign.surface.grid().cell_x) + "  # m, side of the cells of the DEM\n";
  const Range sizes = fitted_diameters(loaded.campaign);
  text += "fitted_diameters = [" + text_of(std::floor(1e3 * sizes.low) / 1e3) + ", " +
          text_of(std::ceil(1e3 * sizes.high) / 1e3) + "]  # m\n";
  if (std::isfinite(skill.share))
    text += "fitted_skill = " + skill_list(skill) +
            "  # share by which the error is below the climatology's; its interval\n";
  for (std::size_t i = 0; i < loaded.campaign.zone_names.size(); ++i) {
    text += "\n[ground.zones." + toml_key(loaded.campaign.zone_names[i]) + "]\n";
    text += "preset = " + toml_text(std::string(kDefaultPreset)) + "\n";
    if (!loaded.zone_codes[i].empty()) text += "code = " + loaded.zone_codes[i] + "  # in a raster of zones\n";
    const std::string numbers = ground_text(model.grounds[i]);
    text += numbers == ground_text(find_preset(kDefaultPreset).ground) ? "# not fitted: as the preset\n" : numbers;
  }
  text += "\n[model]\ndeformation_coefficient = " + text_of(model.impact.deformation_coefficient) + "\n";
  text += std::string("roughness = \"") + (model.impact.roughness == Roughness::Clamp ? "clamp" : "resample") + "\"\n";
  const Campaign& campaign = loaded.campaign;
  return text + effects_text(model.effects, campaign) + barriers_text(model, campaign) + bias_text(model, campaign) +
         band_text(model);
}

}  // namespace talus::io
