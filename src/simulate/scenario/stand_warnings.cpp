#include "talus/simulate/scenario/stand_warnings.hpp"

#include <cmath>
#include <map>

#include "talus/base/text.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"
#include "talus/simulate/scenario/stand_figures.hpp"

namespace talus {
namespace {

// A thin stand at the timber line or on a pasture has fewer stems than others.
constexpr double kThinnestStand = 50.0;   // [1/ha]
constexpr double kMostBasalArea = 100.0;  // [m2/ha]; mountain stands have some 20 to 80
constexpr const char* kForest = "[effects.forest-stems] ";

/// Median over the trees of a list of the basal area of the hectare in which each stands [m2/ha]: land without trees
/// does not count.
double basal_area_around(const TreeList& list) {
  constexpr double kSide = 100.0;  // of a hectare [m]
  const auto hectare = [](const Tree& tree) {
    return std::pair(std::floor(tree.place.x() / kSide), std::floor(tree.place.y() / kSide));
  };
  std::map<std::pair<double, double>, double> sums;
  for (const Tree& tree : list.trees()) sums[hectare(tree)] += stem_section(tree.diameter);
  Median median;
  for (const Tree& tree : list.trees()) median.add(sums[hectare(tree)]);
  return median.value();
}

std::string thin_text(double density) {
  return std::string(kForest) + "the median density of the forest is " + with_digits(density, 2) +
         " stems/ha, stands have 100 to 2000: is it per m2 or per 100 m2, or a share that the crowns cover?";
}

std::string thick_text(double basal_area) {
  return std::string(kForest) + "the median basal area of the forest is about " + readable(basal_area) +
         " m2/ha, more wood than any stand has (20 to 80 in the mountains): it holds too many blocks (unsafe); is the "
         "diameter a girth, the density per another area?";
}

/// Warns where the effects are off without which stems do not act as a forest does.
void warn_of_stems_alone(const Effects& effects, std::vector<std::string>& warnings) {
  if (!find_effect("block-mass")->acts(effects))
    warnings.push_back(
        std::string(kForest) +
        "holds large blocks best without [effects.block-mass], forests hold small ones (unsafe for large "
        "ones): add --effect block-mass.preset=measured, see docs/effects.md");
  if (!find_effect("rest-in-roughness")->acts(effects))
    warnings.push_back(std::string(kForest) +
                       "keeps few blocks without [effects.rest-in-roughness]: one that a stem has stopped moves on "
                       "where the slope is steeper than phi, see docs/effects.md");
}

void warn_of_forest(const Scenario& scenario, std::vector<std::string>& warnings) {
  warn_of_stems_alone(scenario.effects, warnings);
  const ForestStems& forest = scenario.effects.forest_stems;
  double basal_area = 0.0;
  if (forest.lists_trees()) {
    basal_area = basal_area_around(forest.map->trees);
  } else {
    const StandFigures stands = stand_figures(scenario);
    basal_area = stands.basal_areas.value();
    if (stands.densities.value() < kThinnestStand) warnings.push_back(thin_text(stands.densities.value()));
  }
  if (basal_area > kMostBasalArea) warnings.push_back(thick_text(basal_area));
}

void warn_of_drag(const Scenario& scenario, std::vector<std::string>& warnings) {
  const double c = scenario.effects.vegetation_drag.coefficient, density = scenario.blocks.density;
  const Block smallest = block_of(diameters_of(scenario).low, density);
  const bool pieces = scenario.effects.fragmentation.threshold > 0.0, blocks = c > kStuckRate * smallest.mass;
  const double stuck = diameter_of(c / (density * kStuckRate));
  if (!blocks && !(pieces && c > kStuckRate * kSmallestPiece)) return;
  warnings.push_back(std::string("[effects.vegetation-drag] holds ") +
                     (blocks ? "small blocks" : "pieces of broken blocks") + " in the air: " +
                     (blocks ? "the smallest, of " + with_digits(smallest.diameter, 3) +
                                   " m, lose c/m = " + with_digits(c / smallest.mass, 3) + " 1/s of their speed; "
                             : "") +
                     "above c/m = " + text_of(kStuckRate) + " 1/s, here below " + with_digits(stuck, 2) +
                     " m, one is stuck and its fall approximate (unsafe if the stand does not hold it): coefficient "
                     "does not grow with the block, see docs/effects.md");
}

}  // namespace

std::vector<std::string> stand_warnings(const EffectEntry& entry, const Scenario& scenario) {
  std::vector<std::string> warnings;
  if (entry.name == "forest-stems") warn_of_forest(scenario, warnings);
  if (entry.name == "vegetation-drag") warn_of_drag(scenario, warnings);
  return warnings;
}

}  // namespace talus
