#include "talus/simulate/scenario/idle_effects.hpp"

#include <algorithm>

#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"

namespace talus {
namespace {

std::string on_other_days(const EffectEntry& entry, const std::vector<int>& days, int day) {
  std::vector<std::string> words;
  for (const int other : days) words.push_back(std::to_string(other));
  return "[effects." + std::string(entry.name) + "] acts on " + (words.size() == 1 ? "day " : "days ") +
         shortened(joined(words), 100) + ", the day of this run is " + std::to_string(day) +
         ": it does nothing here; give day at the top of the scenario, or leave the effect out";
}

std::string on_spheres(const Vec3& axes) {
  return "[effects.block-shape] acts on blocks that are no spheres, blocks.axes = [" + text_of(axes[0]) + ", " +
         text_of(axes[1]) + ", " + text_of(axes[2]) +
         "] give the shape index 0: it does nothing here; give axes of the blocks, or leave the effect out";
}

}  // namespace

std::vector<std::string> idle_effects(const Scenario& scenario) {
  std::vector<std::string> lines;
  for (const EffectEntry& entry : effect_entries()) {
    const std::vector<int>* days = entry.days(scenario.effects);
    if (days != nullptr && entry.acts(scenario.effects) && std::ranges::count(*days, scenario.day) == 0)
      lines.push_back(on_other_days(entry, *days, scenario.day));
  }
  const Vec3& axes = scenario.blocks.axes;
  if (find_effect("block-shape")->acts(scenario.effects) &&
      shape_index(scenario.effects.block_shape, {1.0, 1.0, axes}) == 0.0)
    lines.push_back(on_spheres(axes));
  return lines;
}

}  // namespace talus
