#include "size_warning.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "fitted_on.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {
namespace {

constexpr double kFitTolerance = 0.1;  // of the diameters to which a ground was fitted: they are measured no better

/// Whether a number of a ground is that of its preset. A complete scenario, as a run writes it, gives every number
/// beside the preset, so that there only the values tell. A model that was fitted (`include`) has its own.
bool from_preset(const ScenarioSpec& spec, const ZoneSpec& zone, const std::string& key) {
  if (!zone.own.contains(key)) return true;
  if (!zone.gives_all() || is_of_fit(spec, zone, key)) return false;
  const Ground& preset = find_preset(zone.preset).ground;
  return std::ranges::any_of(ground_fields(), [&](const auto& field) {
    return field.key == key && field.get(zone.ground) == field.get(preset);
  });
}

/// The grounds of a scenario that are used.
std::vector<const ZoneSpec*> used_grounds(const ScenarioSpec& spec, const Scenario& scenario) {
  const auto& cells = scenario.cover.zones.values;
  std::vector<const ZoneSpec*> used;
  if (cells.empty() || std::find(cells.begin(), cells.end(), 0) != cells.end()) used.push_back(&spec.default_ground);
  for (const ZoneSpec& zone : spec.zones) used.push_back(&zone);
  return used;
}

/// A line if the ground of a 3D run has a preset of the 2D model, and with it no sideways roughness; else empty.
std::string plane_warning(const std::vector<const ZoneSpec*>& grounds) {
  std::string text;
  for (const ZoneSpec* zone : grounds)
    if (is_of_plane(find_preset(zone->preset)) && zone->ground.psi_scale == 0.0)
      text += (text.empty() ? "" : ", ") + ("'" + zone->name + "' (" + zone->preset + ")");
  if (text.empty()) return text;
  return "ground " + text +
         ": the preset is of the 2D model, psi_scale = 0: blocks are not turned sideways there, "
         "the endangered width is too small (unsafe): take a preset whose name ends in -3d, or give psi_scale";
}

/// A line if a factor on the radius lets an impact gain more energy than the factors of the paper do, 1 to 1.5: 14 %.
/// docs/physics.md, "Energy at an impact".
std::string gain_warning(const std::vector<const ZoneSpec*>& grounds) {
  const auto gain = [](double s) { return (10.0 * s * s + 29.0 + 10.0 / (s * s)) / 49.0; };
  std::string text;
  for (const ZoneSpec* zone : grounds) {
    const double most = std::max(gain(zone->ground.shape_min), gain(zone->ground.shape_max));
    if (most > 1.15) text += (text.empty() ? "'" : ", '") + zone->name + "' (by up to " + percent(most - 1.0) + ")";
  }
  if (text.empty()) return text;
  return "ground " + text +
         ": with these factors of shape an impact can gain energy, and a block speed up on level ground; the paper's "
         "are 1 to 1.5 (14 %)";
}

/// A line if the blocks have a shape that nothing reads; else empty.
std::string axes_warning(const Scenario& scenario) {
  const Vec3& axes = scenario.blocks.axes;
  if (axes.x() == axes.z() || find_effect("block-shape")->acts(scenario.effects)) return {};
  return "blocks.axes = [" + text_of(axes.x()) + ", " + text_of(axes.y()) + ", " + text_of(axes.z()) +
         "]: only [effects.block-shape] reads the shape, and it is off: the blocks are spheres";
}

/// A line where barriers are lower than the largest block: the run, to which blocks are points, catches too much there.
std::string low_barrier_warning(const Scenario& scenario) {
  const double largest = diameters_of(scenario).high;
  std::vector<std::string> low;
  for (const Barrier& b : scenario.barriers.list())
    if (b.height > 0.0 && b.height < largest) low.push_back(b.id + " (" + text_of(b.height) + " m)");
  if (low.empty()) return {};
  return "barriers: " + listed(low) + ": lower than the largest block, " + text_of(largest) +
         " m: the run catches a block whose lowest point is below the top, a real barrier only one whose centre is "
         "(unsafe); give the real height less half the largest block. If that is done, all is well";
}

}  // namespace

void warn_of_sizes(const ScenarioSpec& spec, const Scenario& scenario, std::vector<std::string>& warnings) {
  const std::vector<const ZoneSpec*> grounds = used_grounds(spec, scenario);
  std::vector<const Preset*> presets;
  for (const ZoneSpec* zone : grounds)
    if (from_preset(spec, *zone, "theta_scale") || from_preset(spec, *zone, "En50"))
      presets.push_back(&find_preset(zone->preset));
  const std::string file = std::filesystem::path(spec.fitted_on.file.path).filename().string();
  Preset fitted{.name = file, .ground = {}, .source = {}, .where = {}, .sizes = {}};
  if (const std::optional<Range>& sizes = spec.fitted_on.diameters; sizes && uses_fit(spec)) {
    fitted.sizes = {sizes->low, sizes->high, {}, true, true, kFitTolerance};
    presets.push_back(&fitted);
  }
  for (std::string& warning :
       std::vector<std::string>{size_warning(scenario, presets), guess_warning(presets),
                                sorting_warning(scenario.effects), gain_warning(grounds), axes_warning(scenario),
                                low_barrier_warning(scenario), spec.profile ? std::string() : plane_warning(grounds)})
    if (!warning.empty()) warnings.push_back(std::move(warning));
  std::ranges::move(frequency_warnings(scenario), std::back_inserter(warnings));
}

}  // namespace talus::io
