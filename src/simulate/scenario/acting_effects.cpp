#include "talus/simulate/scenario/acting_effects.hpp"

#include <algorithm>

#include "effect_cells.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/stand_figures.hpp"

namespace talus {
namespace {

constexpr const char* kNothing = ": it does nothing here; ";

std::string on_other_days(const std::vector<int>& days, int day) {
  std::vector<std::string> words;
  for (const int other : days) words.push_back(std::to_string(other));
  return std::string("acts on ") + (words.size() == 1 ? "day " : "days ") + shortened(joined(words), 100) +
         ", the day of this run is " + std::to_string(day) + kNothing +
         "give day at the top of the scenario, or leave the effect out";
}

std::string on_spheres(const Vec3& axes) {
  return "acts on blocks that are no spheres, blocks.axes = [" + text_of(axes[0]) + ", " + text_of(axes[1]) + ", " +
         text_of(axes[2]) + "] give the shape index 0" + kNothing + "give axes of the blocks, or leave the effect out";
}

std::string nowhere(const EffectEntry& entry) {
  return std::string("acts nowhere, as its zones or polygons cover no cell of the DEM") +
         (entry.mapped ? " with a forest" : "") + kNothing + "mend them, or leave the effect out";
}

/// Why an effect that is on does nothing; empty: it acts.
std::string idle_text(const EffectEntry& entry, const Scenario& scenario, std::uint64_t cells) {
  const std::string name = "[effects." + std::string(entry.name) + "] ";
  const std::vector<int>* days = entry.days(scenario.effects);
  const Vec3& axes = scenario.blocks.axes;
  std::string why;
  if (days != nullptr && std::ranges::count(*days, scenario.day) == 0) why += name + on_other_days(*days, scenario.day);
  if (entry.name == "block-shape" && shape_index(scenario.effects.block_shape, {1.0, 1.0, axes}) == 0.0)
    why += name + on_spheres(axes);
  if (cells == 0) why += (why.empty() ? "" : ". ") + name + nowhere(entry);
  return why;
}

/// "density = 250 to 450 (mean 386) 1/ha, height = 20 m".
std::string numbers_text(const EffectEntry& entry, const Scenario& scenario) {
  const bool of_list = entry.mapped && scenario.effects.forest_stems.lists_trees();
  const StandFigures stands = entry.mapped && !of_list ? stand_figures(scenario) : StandFigures{};
  std::vector<std::string> words;
  for (const EffectField& field : entry.fields()) {
    if (field.by_cell && of_list) continue;  // each tree has its own
    const std::string value = !field.by_cell        ? text_of(field.get(scenario.effects))
                              : field.is_strength() ? stands.density.text()
                                                    : stands.diameter.text();
    words.push_back(std::string(entry.key_of(field)) + " = " + value +
                    (field.unit == "1" ? "" : " " + std::string(field.unit)));
  }
  return joined(words);
}

/// "acts in 3520 of 32000 cells (8.8 ha)"; on a profile "acts along 40 of 200 m".
std::string place_text(const Scenario& scenario, std::uint64_t cells, std::uint64_t all) {
  const Grid& grid = scenario.surface.grid();
  const auto number = static_cast<double>(cells);
  if (scenario.impact.in_plane) {
    const double length = (grid.columns - 1) * grid.cell_x;  // a column at each end
    return "acts along " + with_decimals(std::min(length, number * grid.cell_x), 0) + " of " +
           with_decimals(length, 0) + " m";
  }
  return "acts in " + std::to_string(cells) + " of " + std::to_string(all) + " cells (" +
         readable(number * grid.cell_x * grid.cell_y * 1e-4) + " ha)";
}

std::uint64_t cells_with_height(const Raster<float>& heights) {
  std::uint64_t count = 0;
  for_each_row(heights, [&](int row) {
    for (int column = 0; column < heights.grid.columns; ++column)
      count += std::isnan(heights.at(column, row)) ? 0U : 1U;
  });
  return count;
}

}  // namespace

std::vector<EffectUse> effects_in_use(const Scenario& scenario) {
  std::vector<EffectUse> uses;
  if (!scenario.effects.any()) return uses;
  const std::uint64_t all = cells_with_height(scenario.surface.heights());
  for (const EffectEntry& entry : effect_entries()) {
    if (!entry.acts(scenario.effects)) continue;
    EffectUse use{&entry, 0, {}, {}};
    EffectCells(entry, scenario).for_each([&](int, int row) {
      use.cells += scenario.impact.in_plane && row > 0 ? 0U : 1U;  // the rows of a profile are alike
    });
    use.idle = idle_text(entry, scenario, use.cells);
    if (use.acts())
      use.text =
          std::string(entry.name) + " " + place_text(scenario, use.cells, all) + ": " + numbers_text(entry, scenario);
    uses.push_back(std::move(use));
  }
  return uses;
}

}  // namespace talus
