#include "fitted_on.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr double kOtherCells = 1.5;  // ratio of two sizes of cells; from 0.5 to 1 m the run-out changed by 1 %

}  // namespace

void warn_of_other_terrain(const ScenarioSpec& spec, const Grid& grid, SurfaceKind kind, const std::string& where,
                           const std::string& used, const std::string& remedy, std::vector<std::string>& warnings) {
  if (spec.model_surface && *spec.model_surface != kind)
    warnings.push_back(where + ": was fitted on a " + std::string(name_of(*spec.model_surface)) + " surface, and " +
                       used + " on a " + std::string(name_of(kind)) + " one" + remedy);
  if (!spec.model_cell) return;
  const double fitted = *spec.model_cell, here = grid.cell_x;
  if (std::max(fitted, here) < kOtherCells * std::min(fitted, here)) return;
  warnings.push_back(where + ": was fitted on cells of " + with_digits(fitted, 3) + " m, and " + used +
                     " on cells of " + with_digits(here, 3) +
                     " m: where the ground is uneven, coarser cells carry the same blocks " +
                     "farther: take a DEM of like cells, or fit again");
}

}  // namespace talus::io
