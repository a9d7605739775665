#include "talus/simulate/scenario/stand_warnings.hpp"

#include "talus/base/text.hpp"
#include "talus/simulate/scenario/stand_figures.hpp"

namespace talus {
namespace {

// A thin stand at the timber line or on a pasture has fewer stems than others.
constexpr double kThinnestStand = 50.0;  // [1/ha]
constexpr const char* kForest = "[effects.forest-stems] ";

std::string thin_text(double density) {
  return std::string(kForest) + "the median density of the forest is " + with_digits(density, 2) +
         " stems/ha, stands have 100 to 2000: is it per m2 or per 100 m2, or a share that the crowns cover?";
}

void warn_of_forest(const Scenario& scenario, std::vector<std::string>& warnings) {
  if (scenario.effects.forest_stems.lists_trees()) return;
  const double density = stand_figures(scenario).densities.value();
  if (density < kThinnestStand) warnings.push_back(thin_text(density));
}

}  // namespace

std::vector<std::string> stand_warnings(const EffectEntry& entry, const Scenario& scenario) {
  std::vector<std::string> warnings;
  if (entry.name == "forest-stems") warn_of_forest(scenario, warnings);
  return warnings;
}

}  // namespace talus
