#include "acting_record.hpp"

#include <algorithm>

#include "talus/physics/effects/registry.hpp"

namespace talus::io {
namespace {

bool is_given(const Json& settings, const std::string& effect) {
  return std::ranges::any_of(settings, [&](const Json& setting) {
    return setting.at("key").get<std::string>().starts_with("effects." + effect + ".");
  });
}

bool is_on_a_wet_day(const Json& settings) {
  Json day = 0.0, days = "[]";
  for (const Json& setting : settings) {
    if (setting.at("key") == "day") day = setting.at("value");
    if (setting.at("key") == "effects.wet-ground.days") days = setting.at("value");
  }
  const std::vector<double> wet = Json::parse(days.get<std::string>());
  return std::ranges::count(wet, day.get<double>()) > 0;
}

}  // namespace

std::vector<std::string> acting_in(const Json& run) {
  std::vector<std::string> names;
  if (run.contains("effects")) {
    for (const Json& effect : run.at("effects")) names.push_back(effect.at("name").get<std::string>());
    return names;
  }
  const Json settings = run.value("settings", Json::array());
  for (const EffectEntry& entry : effect_entries()) {
    std::string name(entry.name);
    if (is_given(settings, name) && (name != "wet-ground" || is_on_a_wet_day(settings)))
      names.push_back(std::move(name));
  }
  return names;
}

}  // namespace talus::io
