#include "talus/simulate/scenario/block_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "talus/base/text.hpp"

namespace talus {
namespace {

void widen(Range& all, const Range& range) {
  all = {std::min(all.low, range.low), std::max(all.high, range.high)};
}

std::string metres(const Range& range) {
  const std::string low = with_digits(range.low, 3), high = with_digits(range.high, 3);
  return (low == high ? low : low + " to " + high) + " m";
}

/// Whether a preset was fitted to other sizes, or to sizes that are not known.
bool strange_to(const Preset& preset, const Range& diameters, bool smaller_pieces) {
  constexpr double kRounding = 1e-9;
  return !preset.sizes.known() || smaller_pieces || diameters.low < preset.sizes.smallest * (1.0 - kRounding) ||
         diameters.high > preset.sizes.largest * (1.0 + kRounding);
}

}  // namespace

Range diameters_of(const Scenario& scenario) {
  Range all{INFINITY, 0.0};
  bool general = scenario.features.empty();
  for (const SourceFeature& feature : scenario.features)
    if (std::isnan(feature.diameter.low))
      general = true;
    else
      widen(all, feature.diameter);
  if (!general) return all;
  const Range& volume = scenario.blocks.power_law.volume;
  if (volume.high > 0.0) widen(all, {std::cbrt(6.0 / kPi * volume.low), std::cbrt(6.0 / kPi * volume.high)});
  for (const BlockClass& block : scenario.blocks.classes) widen(all, block.diameter);
  return all;
}

std::string size_warning(const Scenario& scenario, std::span<const Preset* const> presets) {
  const Range diameters = diameters_of(scenario);
  const bool break_up = scenario.effects.fragmentation.threshold > 0.0;
  std::vector<std::string> strange;
  for (const Preset* preset : presets) {
    if (!strange_to(*preset, diameters, break_up)) continue;
    const FittedSizes& sizes = preset->sizes;
    strange.push_back(std::string(preset->name) + " (" +
                      (sizes.known() ? metres({sizes.smallest, sizes.largest}) : "not known") + ")");
    if (std::count(strange.begin(), strange.end(), strange.back()) > 1) strange.pop_back();
  }
  if (strange.empty()) return {};
  const bool scaled = find_effect("block-mass")->acts(scenario.effects);
  return std::string(kSizeWarning) + "diameters are " + metres(diameters) + (break_up ? ", of pieces less" : "") +
         ", the ground was fitted to others: " + joined(strange) +
         (scaled ? "; [effects.block-mass] changes roughness and damping with the size here, see docs/effects.md"
                 : "; expect small blocks to run faster and jump higher than large ones, against field experience "
                   "(E_d grows with D, the roughness ignores it): see docs/physics.md, \"Parameter sets\"");
}

}  // namespace talus
