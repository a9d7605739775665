#include "talus/simulate/scenario/presets.hpp"

#include <array>
#include <string>
#include <vector>

#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus {

namespace {

// theta_scale, psi_scale, En50 [m^3/s^2], largest shape factor; in every table Et50 = 50, phi = 30 deg, shape from 1.
Ground ground_of(double theta_scale, double psi_scale, double en50, double shape_max) {
  Ground ground{theta_scale, psi_scale, en50, 50.0, 0.0, 1.0, shape_max};
  for (const auto& field : ground_fields())
    if (field.key == "phi") field.set(ground, 30.0);
  return ground;
}

// Mitchell & Hungr, PIERRE 2.
const std::array<Preset, 7>& all() {
  static const std::array<Preset, 7> presets{{
      {"firm-talus-2d", ground_of(0.7, 0.0, 15.0, 1.5), "Table 1", "firm talus, Vaujany and Ehime, in 2D"},
      {"forest-road-2d", ground_of(0.4, 0.0, 15.0, 1.5), "Table 1", "forest road, in 2D"},
      {"quarry-face-2d", ground_of(0.65, 0.0, 5.0, 1.0), "Table 2", "face of a quarry, in 2D"},
      {"quarry-floor-2d", ground_of(0.35, 0.0, 5.0, 1.0), "Table 2", "floor of a quarry, in 2D"},
      {"upper-talus-3d", ground_of(1.0, 0.9, 15.0, 1.5), "Table 3", "upper talus, Vaujany, in 3D"},
      {"forest-road-3d", ground_of(0.4, 0.3, 15.0, 1.5), "Table 3", "forest road, Vaujany, in 3D"},
      {"lower-talus-3d", ground_of(1.5, 1.0, 15.0, 1.5), "Table 3", "lower talus, Vaujany, in 3D"},
  }};
  return presets;
}

}  // namespace

std::span<const Preset> presets() {
  return all();
}

const Preset& find_preset(std::string_view name) {
  std::vector<std::string> names;
  for (const Preset& preset : all()) {
    if (preset.name == name) return preset;
    names.emplace_back(preset.name);
  }
  throw InputError("unknown preset '" + std::string(name) + "'" + known_names(name, names));
}

}  // namespace talus
