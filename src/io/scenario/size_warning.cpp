#include "size_warning.hpp"

#include <algorithm>

#include "talus/simulate/scenario/block_sizes.hpp"

namespace talus::io {

void warn_of_sizes(const ScenarioSpec& spec, const Scenario& scenario, std::vector<std::string>& warnings) {
  const auto& cells = scenario.cover.zones.values;
  std::vector<const Preset*> presets;
  const auto add = [&presets](const ZoneSpec& zone) {
    if (!zone.own.contains("theta_scale") || !zone.own.contains("En50")) presets.push_back(&find_preset(zone.preset));
  };
  if (cells.empty() || std::find(cells.begin(), cells.end(), 0) != cells.end()) add(spec.default_ground);
  for (const ZoneSpec& zone : spec.zones) add(zone);
  for (std::string& warning : std::vector<std::string>{size_warning(scenario, presets), guess_warning(presets),
                                                       sorting_warning(scenario.effects)})
    if (!warning.empty()) warnings.push_back(std::move(warning));
}

}  // namespace talus::io
