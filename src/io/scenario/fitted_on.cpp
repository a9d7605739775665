#include "fitted_on.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr double kOtherCells = 1.5;  // ratio of two sizes of cells; from 0.5 to 1 m the run-out changed by 1 %

}  // namespace

void warn_of_other_terrain(const ScenarioSpec& spec, const Grid& grid, SurfaceKind kind, const std::string& where,
                           const std::string& used, const std::string& remedy, std::vector<std::string>& warnings) {
  const FittedOn& on = spec.fitted_on;
  if (on.surface && *on.surface != kind)
    warnings.push_back(where + ": was fitted on a " + std::string(name_of(*on.surface)) + " surface, and " + used +
                       " on a " + std::string(name_of(kind)) + " one" + remedy);
  if (!on.cell) return;
  const double fitted = *on.cell, here = grid.cell_x;
  if (std::max(fitted, here) < kOtherCells * std::min(fitted, here)) return;
  warnings.push_back(where + ": was fitted on cells of " + with_digits(fitted, 3) + " m, and " + used +
                     " on cells of " + with_digits(here, 3) +
                     " m: where the ground is uneven, coarser cells carry the same blocks " +
                     "farther: take a DEM of like cells, or fit again");
}

bool uses_fit(const ScenarioSpec& spec) {
  const auto of_fit = [](const ZoneSpec& zone) {
    return std::ranges::any_of(zone.own, [](const auto& number) { return number.second != "scenario"; });
  };
  return of_fit(spec.default_ground) || std::ranges::any_of(spec.zones, of_fit);
}

void warn_of_other_coefficient(const ScenarioSpec& spec, std::vector<std::string>& warnings) {
  const std::optional<double>& fitted = spec.fitted_on.deformation_coefficient;
  const double here = spec.values.impact.deformation_coefficient;
  if (!fitted || here == *fitted || !uses_fit(spec)) return;
  warnings.push_back(spec.include.where + ": was fitted with the deformation coefficient c = " + text_of(*fitted) +
                     ", and this run takes " + text_of(here) + " (" + spec.origin("model.deformation_coefficient") +
                     "): a fitted ground holds only for the c of its fit: fit it again with this c, in [model] of the "
                     "model from which the fit starts (--parameters)");
}

}  // namespace talus::io
