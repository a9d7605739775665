#include "talus/simulate/scenario/block_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "talus/base/text.hpp"
#include "talus/simulate/scenario/block_class.hpp"
#include "talus/simulate/scenario/frequency.hpp"

namespace talus {
namespace {

void widen(Range& all, const Range& range) {
  all = {std::min(all.low, range.low), std::max(all.high, range.high)};
}

bool below(const FittedSizes& sizes, const Range& diameters) {
  return sizes.known() && diameters.low < sizes.smallest * (1.0 - sizes.tolerance);
}

bool above(const FittedSizes& sizes, const Range& diameters) {
  return sizes.known() && diameters.high > sizes.largest * (1.0 + sizes.tolerance);
}

/// What is wrong with blocks that are larger, or smaller, than those that the ground was fitted to.
std::string direction(bool larger, bool smaller) {
  std::string text;
  if (larger)
    text +=
        "; larger blocks: run-out and speed too low (unsafe): run with --effect block-mass.preset=measured, too, "
        "and take the higher hazard";
  if (smaller)
    text += "; smaller blocks: at both measured sites they went farther than by the default ground: fit the ground";
  if (text.empty()) text = "; small blocks run faster and jump higher than large ones, against field experience";
  return text + ": see docs/physics.md, \"Parameter sets\"";
}

/// Whether block-mass acts with the numbers of its preset on sizes that the preset was not fitted to. At its reference
/// diameter it changes nothing.
bool extrapolates(const BlockMass& effect, const EffectPreset& preset, const Range& diameters) {
  const BlockMass& numbers = preset.numbers.block_mass;
  if (effect.roughness != numbers.roughness || effect.stiffness != numbers.stiffness ||
      effect.reference_diameter != numbers.reference_diameter)
    return false;
  FittedSizes sizes = preset.sizes;
  sizes.largest = std::max(sizes.largest, numbers.reference_diameter);
  return below(sizes, diameters) || above(sizes, diameters);
}

std::string extrapolation_of_block_mass(const Scenario& scenario, const Range& diameters) {
  const EffectPreset& measured = find_preset("block-mass", "measured");
  if (!extrapolates(scenario.effects.block_mass, measured, diameters)) return {};
  return "; [effects.block-mass] preset measured was fitted to " +
         metres({measured.sizes.smallest, measured.sizes.largest}) +
         ": here it is an extrapolation, see docs/effects.md";
}

}  // namespace

std::string metres(const Range& range) {
  const std::string low = with_digits(range.low, 3), high = with_digits(range.high, 3);
  return (low == high ? low : low + " to " + high) + " m";
}

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
  if (volume.high > 0.0) widen(all, {diameter_of(volume.low), diameter_of(volume.high)});
  for (const BlockClass& block : scenario.blocks.classes) widen(all, block.diameter);
  return all;
}

std::string size_warning(const Scenario& scenario, std::span<const Preset* const> presets) {
  const Range diameters = diameters_of(scenario);
  const bool break_up = scenario.effects.fragmentation.threshold > 0.0;
  bool larger = false, smaller = false;
  std::vector<std::string> strange, unknown;  // fitted to other sizes, to sizes that are not known
  for (const Preset* preset : presets) {
    const FittedSizes& sizes = preset->sizes;
    if (!sizes.fitted) continue;  // `guess_warning`
    const bool over = above(sizes, diameters),
               under = below(sizes, diameters) || (sizes.known() && !sizes.of_pieces && break_up);
    if (sizes.known() && !over && !under) continue;
    larger = larger || over, smaller = smaller || under;
    std::vector<std::string>& list = sizes.known() ? strange : unknown;
    list.push_back(std::string(preset->name) +
                   (sizes.known() ? " (" + metres({sizes.smallest, sizes.largest}) + ")" : ""));
    if (std::count(list.begin(), list.end(), list.back()) > 1) list.pop_back();
  }
  const std::string extrapolation = extrapolation_of_block_mass(scenario, diameters);
  if (strange.empty() && unknown.empty() && extrapolation.empty()) return {};
  std::string text = std::string(kOtherSizes) + metres(diameters) + (break_up ? ", of pieces less" : "");
  if (!strange.empty()) text += ", the ground was fitted to others: " + joined(strange);
  if (!unknown.empty()) text += ", the sizes that the ground was fitted to are not known: " + joined(unknown);
  if (!extrapolation.empty()) return text + extrapolation;
  return text + (find_effect("block-mass")->acts(scenario.effects)
                     ? "; [effects.block-mass] changes roughness and damping with the size here, see docs/effects.md"
                     : direction(larger, smaller));
}

std::string guess_warning(std::span<const Preset* const> presets) {
  std::vector<std::string> names;
  for (const Preset* preset : presets)
    if (!preset->sizes.fitted && std::count(names.begin(), names.end(), preset->name) == 0)
      names.emplace_back(preset->name);
  if (names.empty()) return {};
  return std::string(kGuessWarning) + "ground " + joined(names) +
         " is for migration and fitted to no data; "
         "run-out may be too short (rough types: unsafe) or too long (smooth ones): see docs/migration.md";
}

std::string rare_class_warning(const Scenario& scenario) {
  constexpr double kFew = 20.0;  // blocks of a class in one round
  constexpr double kNone = 3.0;  // below it a round has none of them in more than 5 % of the cases
  const std::vector<double> frequencies = class_frequencies(scenario);
  const auto& classes = scenario.blocks.classes;
  if (frequencies.size() < 2 || frequencies.size() != classes.size()) return {};
  const double weights = total_weight(classes);
  const double events = std::accumulate(frequencies.begin(), frequencies.end(), 0.0);
  std::vector<std::string> rare;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const double drawn = static_cast<double>(scenario.released()) * classes[i].weight / weights;
    if (frequencies[i] > 0.0 && drawn < kFew)
      rare.push_back(metres(classes[i].diameter) + " (" + percent(frequencies[i] / events) + " of the events, about " +
                     with_digits(drawn, 2) + " of " + std::to_string(scenario.released()) + " blocks in a round" +
                     (drawn < kNone ? ": if there is none, its events are in the total and in no map" : "") + ")");
  }
  if (rare.empty()) return {};
  return std::string(kSizeWarning) + std::string(kRareClasses) + joined(rare) +
         ": give it a larger weight, which changes no frequency, or more trajectories";
}

std::string sorting_warning(const Effects& effects) {
  if (!find_effect("rest-in-roughness")->acts(effects) || find_effect("block-mass")->acts(effects)) return {};
  return std::string(kSizeWarning) +
         "[effects.rest-in-roughness] without [effects.block-mass] sorts them the wrong way, large blocks high and "
         "small ones far: add --effect block-mass.preset=measured, see docs/effects.md";
}

}  // namespace talus
