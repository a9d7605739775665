#include "talus/simulate/scenario/stand_figures.hpp"

#include <algorithm>
#include <cmath>

#include "effect_cells.hpp"
#include "talus/base/text.hpp"

namespace talus {
void Spread::add(double value) {
  low = std::min(low, value), high = std::max(high, value), sum += value;
  ++count;
}

std::string Spread::text() const {
  const std::string first = with_digits(low, 3), last = with_digits(high, 3);
  return first == last ? first : first + " to " + last + " (mean " + with_digits(mean(), 3) + ")";
}

void Median::add(double value) {
  const double bin = std::floor(kPerDecade * (std::log10(value) - kFirst));
  ++counts_[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))];
  ++all_;
}

double Median::value() const {
  if (all_ == 0) return 0.0;
  std::size_t bin = 0;
  for (std::uint64_t below = counts_[0]; 2 * below < all_;) below += counts_[++bin];
  return std::pow(10.0, kFirst + (static_cast<double>(bin) + 0.5) / kPerDecade);
}

double stem_section(double diameter) {
  return 0.25 * kPi * diameter * diameter;
}

StandFigures stand_figures(const Scenario& scenario) {
  const ForestStems& forest = scenario.effects.forest_stems;
  StandFigures figures;
  const bool by_cell = forest.by_cell();
  EffectCells(*find_effect("forest-stems"), scenario).for_each([&](int column, int row) {
    if (!by_cell && figures.density.count > 0) return;  // all are equal
    const Stand stand = stand_in(forest, column, row);
    figures.density.add(stand.density), figures.diameter.add(stand.diameter);
    figures.densities.add(stand.density);
    figures.basal_areas.add(stand.density * stem_section(stand.diameter));
  });
  return figures;
}

}  // namespace talus
