#include "talus/products/hazard_table.hpp"

#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "raster_parts.hpp"
#include "talus/base/expect.hpp"
#include "talus/products/energy_words.hpp"

namespace talus {
namespace {

using Kind = Map::Kind;
using Figures = std::vector<float>;

void push(Figures& figures, const Bounded& bounded) {
  constexpr double kMost = std::numeric_limits<float>::max();  // more years than that are as good as never
  for (const double value : {bounded.value, bounded.low, bounded.high})
    figures.push_back(static_cast<float>(std::abs(value) <= kMost ? value : kNotGiven));
}

/// The class; the class at the lower and at the upper bounds; 1 if these two differ: this many trajectories do not
/// decide the class; 1 if paths leave the map here: it ends before the hazard does.
void push_classes(const HazardPlace& place, Figures& figures) {
  std::vector<Bounded> frequencies{place.levels[0]};
  for (const double energy : place.matrix.energies) frequencies.push_back(place.exceedance_of(energy));
  const BoundedClass found = class_of(place.matrix, frequencies);
  for (const int figure : {found.value, found.low, found.high, int{found.undecided}, int{place.exit}})
    figures.push_back(static_cast<float>(figure));
}

/// The frequency of exceeding each of `energies_of_curves`.
void push_curve(const HazardPlace& place, Figures& figures) {
  if (place.curve == nullptr) {
    for (const Bounded& level : place.levels) figures.push_back(static_cast<float>(level.value));
    return;
  }
  for (const CurveEnergy& of : curve_energies(place.rules.bins))
    figures.push_back(static_cast<float>(place.curve->frequency_from(of.bin)));
}

std::string capitalised(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// The classes of the matrix. The colours of the marks differ from those of the classes and from a hillshade, also for
/// the colour-blind (tests/io/style_test.cpp).
HazardRaster class_raster(const EnergyWords& energy) {
  return {
      .map = {"hazard_class",
              "Class of hazard of the cell by intensity" + energy.remark + " and return period, in plan, at any height",
              Kind::Count,
              {{"class", "class"},
               {"class at lower bound", "class"},
               {"class at upper bound", "class"},
               {"undecided", "1"},
               {"cut short", "1"}},
              {{1, 2, 3, 4, 5}, 1.0, "", Palette::HazardClasses, "", true, true},
              false,
              {},
              {{"cut short", "paths leave the map here", "#c30fa5"},
               {"undecided", "not decided by so few blocks", "#ff6d00"}}},
      .meaning =
          "class of the matrix; `undecided` is 1 where the classes at the bounds differ, `cut short` where "
          "paths leave the map",
      .figures = [](const HazardPlace& place, std::size_t, Figures& figures) { push_classes(place, figures); },
      .has_classes = true};
}

HazardRaster annual_frequency() {
  return {.map = {"annual_frequency",
                  "Mean number of blocks that pass the cell in a year, in plan, at any height",
                  Kind::Quantity,
                  bounded_bands("annual frequency (in plan, at any height)", "1/year"),
                  {{1e-4, 1e-3, 1e-2, 1e-1, 1.0}, 1.0, "1/year", Palette::Plasma}},
          .meaning = "trajectories that pass the cell per year",
          .figures = [](const HazardPlace& place, std::size_t, Figures& figures) { push(figures, place.levels[0]); }};
}

HazardRaster return_periods(const EnergyWords& energy) {
  return {.map = {"return_period_<kJ>",
                  "Years between blocks of more than <kJ> kJ" + energy.remark +
                      " that pass the cell, in plan, at any height",
                  Kind::Quantity,
                  bounded_bands("return period of " + energy.symbol + " > <kJ> kJ", "years"),
                  {{10, 30, 100, 300, 1000}, 1.0, "years", Palette::PuBuGnFromDark, "", false},
                  true},
          .meaning = "1 / frequency of exceeding the energy; one file per energy threshold",
          .figures = [](const HazardPlace& place, std::size_t i,
                        Figures& figures) { push(figures, return_period(place.levels[i + 1])); },
          .placeholder = "<kJ>",
          .numbers =
              [](const HazardRules& rules, const HazardMatrix&) {
                return std::vector<double>(rules.bins.thresholds().begin(), rules.bins.thresholds().end());
              }};
}

HazardRaster intensities(const EnergyWords& energy) {
  Legend legend = energy_legend("");
  legend.names_in_file = true;
  return {
      .map = {"intensity_T<years>", capitalised(energy.noun) + " that is exceeded once in <years> years in the cell",
              Kind::Quantity, bounded_bands(energy.name + " once in <years> years", "kJ"), std::move(legend)},
      .meaning = "energy that is exceeded once in so many years",
      .figures = [](const HazardPlace& place, std::size_t i,
                    Figures& figures) { push(figures, place.curve->energy_once_in(place.matrix.years[i])); },
      .placeholder = "<years>",
      .numbers = [](const HazardRules&, const HazardMatrix& matrix) { return matrix.years; },
      .needs_curve = true};
}

HazardRaster hazard_curves(const EnergyWords& energy) {
  return {.map = {"hazard_curves",
                  "Mean number of blocks above an energy" + energy.remark +
                      " that pass the cell in a year, in plan, at any height",
                  Kind::Quantity,
                  {{"annual frequency of " + energy.symbol + " > <kJ> kJ (in plan, at any height)", "1/year"}},
                  {{1e-4, 1e-3, 1e-2, 1e-1, 1.0}, 1.0, "1/year", Palette::Plasma}},
          .meaning = "trajectories above the energy per year; one band per energy; with `--curves`",
          .figures = [](const HazardPlace& place, std::size_t, Figures& figures) { push_curve(place, figures); },
          .band_energies = energies_of_curves};
}

Map with_number(Map map, const std::string& placeholder, double value) {
  map.name = replaced(map.name, placeholder, text_of(value));
  map.title = replaced(map.title, placeholder, text_of(value));
  for (Map::Band& band : map.bands) band.name = replaced(band.name, placeholder, text_of(value));
  return map;
}

/// A map with a copy of its only band for each energy [kJ].
Map with_bands(Map map, const std::vector<double>& energies) {
  const Map::Band band = map.bands.front();
  map.bands.clear();
  for (const double energy : energies) map.bands.push_back({replaced(band.name, "<kJ>", text_of(energy)), band.unit});
  return map;
}

/// The texts of a map for an object of some width.
Map of_object(Map map, const ObjectWidth& object) {
  const std::string what = "an object " + text_of(object.width) + " m wide";
  map.title = with_height(replaced(map.title, "the cell", what), object.below);
  for (Map::Band& band : map.bands)
    band.name = with_height(replaced(band.name, " (in plan", " of " + what + " (in plan"), object.below);
  return map;
}

std::vector<HazardRaster> make_hazard_rasters(const EnergyWords& energy) {
  return {annual_frequency(), return_periods(energy), intensities(energy), class_raster(energy), hazard_curves(energy)};
}

}  // namespace

const std::vector<HazardRaster>& hazard_rasters(bool with_rotation) {
  static const std::vector<HazardRaster> translational = make_hazard_rasters(energy_words(false));
  static const std::vector<HazardRaster> total = make_hazard_rasters(energy_words(true));
  return with_rotation ? total : translational;
}

Bounded HazardPlace::exceedance_of(double energy) const {
  if (curve != nullptr) return curve->exceedance_of(energy);
  const auto threshold = rules.bins.threshold_at(energy);
  TALUS_EXPECT(threshold, "without a curve the limits of the matrix are thresholds");
  return levels[*threshold + 1];
}

std::vector<double> energies_of_curves(const HazardRules& rules, const ObjectWidth& object) {
  std::vector<double> energies;
  for (const CurveEnergy& of : curve_energies(rules.bins))
    if (!(object.width > 0.0) || of.energy == 0.0 || rules.bins.threshold_at(of.energy)) energies.push_back(of.energy);
  return energies;
}

std::vector<HazardMap> hazard_maps_of(const HazardRules& rules, const HazardMatrix& matrix, const ObjectWidth& object,
                                      bool curves) {
  std::vector<HazardMap> maps;
  for (const HazardRaster& raster : hazard_rasters(rules.with_rotation)) {
    if (raster.needs_curve && object.width > 0.0) continue;
    if (raster.band_energies) {
      if (curves) maps.push_back({&raster, 0, with_bands(raster.map, raster.band_energies(rules, object))});
      continue;
    }
    if (raster.placeholder.empty()) {
      maps.push_back({&raster, 0, raster.map});
      if (raster.has_classes) maps.back().map.classes = matrix.names;
      continue;
    }
    const std::vector<double> numbers = raster.numbers(rules, matrix);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      maps.push_back({&raster, i, with_number(raster.map, raster.placeholder, numbers[i])});
  }
  if (object.width > 0.0)
    for (HazardMap& map : maps) map.map = of_object(std::move(map.map), object);
  return maps;
}

}  // namespace talus
