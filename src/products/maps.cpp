#include "talus/products/maps.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "talus/products/quiet_regions.hpp"
#include "talus/products/raster_table.hpp"
#include "talus/simulate/plan/region.hpp"

namespace talus {
namespace {

/// The rule of a raster, for several threads: a rule keeps what it has computed, so that each thread takes one for
/// itself and puts it back.
class SpareRules {
 public:
  explicit SpareRules(std::function<CellRule()> make) : make_(std::move(make)) {}

  CellRule take() {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) return make_();
    CellRule rule = std::move(free_.back());
    free_.pop_back();
    return rule;
  }
  void put_back(CellRule rule) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(rule));
  }

 private:
  std::function<CellRule()> make_;
  std::mutex mutex_;
  std::vector<CellRule> free_;
};

std::vector<double> untouched_values(const RunRaster& raster, const RunCounts& run, std::size_t bands) {
  if (raster.untouched) return raster.untouched(run);
  return std::vector<double>(bands, raster.map.kind == Map::Kind::Quantity ? kNotGiven : 0.0);
}

/// The values of a raster of the tally: a rule for touched cells, and by band the value where nothing crosses.
struct TallyValues {
  const Raster<float>& heights;
  const Tally& tally;
  std::vector<double> untouched;
  std::shared_ptr<const QuietRegions> quiet;

  void of_cell(int column, int row, const CellRule& rule, std::span<double> values) const {
    if (const CellRecord* const record = tally.find(column, row); record != nullptr)
      rule({*record, tally.exceedances(column, row), tally.lengths_above(column, row), tally.energy_total(column, row)},
           values);
    else if (!std::isnan(heights.at(column, row)))
      std::ranges::copy(untouched, values.begin());
    else
      std::ranges::fill(values, kNotGiven);
  }

  /// A part of a row within one region.
  void of_part(const CellWindow& part, const CellRule& rule, std::span<double> values) const {
    const std::size_t bands = untouched.size();
    if (const Quiet state = quiet->of(part); state == Quiet::NoTerrain) {
      std::ranges::fill(values, kNotGiven);
      return;
    } else if (state == Quiet::Terrain) {
      for (std::size_t i = 0; i < values.size(); i += bands) std::ranges::copy(untouched, &values[i]);
      return;
    }
    const int end = part.column + part.columns;
    for (int column = part.column; column < end; ++column) tally.prefetch_record(column, part.row);
    for (int column = part.column; column < end; ++column, values = values.subspan(bands))
      of_cell(column, part.row, rule, values.first(bands));
  }

  void of_window(const CellWindow& window, const CellRule& rule, std::span<double> values) const {
    const int end = window.column + window.columns;
    for (int row = window.row; row < window.row + window.rows; ++row) {
      if (row % kRowsBetween == 0) tally.memory().keep_below_limit();  // reading a record loads its neighbours too
      for (int column = window.column, next = 0; column < end; column = next) {
        next = std::min(end, (column / kRegionSide + 1) * kRegionSide);
        const std::size_t size = static_cast<std::size_t>(next - column) * untouched.size();
        of_part({column, row, next - column, 1}, rule, values.first(size));
        values = values.subspan(size);
      }
    }
  }

  static constexpr int kRowsBetween = 4;  // asking the system takes as long as computing several cells
};

auto filling(TallyValues values, std::function<CellRule()> make_rule) {
  return [values = std::move(values), rules = std::make_shared<SpareRules>(std::move(make_rule))](
             const CellWindow& window, std::span<double> to) {
    CellRule rule = rules->take();
    values.of_window(window, rule, to);
    rules->put_back(std::move(rule));
  };
}

/// The value of each band where nothing happens.
auto quiet_values(std::shared_ptr<const QuietRegions> quiet, std::vector<double> untouched) {
  return [quiet = std::move(quiet),
          untouched = std::move(untouched)](const CellWindow& window) -> std::optional<std::vector<double>> {
    switch (quiet->of(window)) {
      case Quiet::Terrain:
        return untouched;
      case Quiet::NoTerrain:
        return std::vector<double>(untouched.size(), kNotGiven);
      default:
        return std::nullopt;
    }
  };
}

/// State of a window where nothing happens.
Quiet quiet_terrain(const Raster<float>& heights, const CellWindow& window) {
  heights.values.memory().keep_below_limit();
  std::size_t missing = 0;
  for (int row = window.row; row < window.row + window.rows; ++row) {
    const float* const first = &heights.at(window.column, row);
    for (int column = 0; column < window.columns; ++column) missing += std::isnan(first[column]) ? 1U : 0U;
  }
  return quiet_of(window.cells() - missing, window);
}

/// For each region, whether blocks are released in it.
std::vector<bool> regions_of_sources(const Scenario& scenario) {
  const Grid& grid = scenario.surface.grid();
  const Regions layout(grid);
  std::vector<bool> regions(layout.count());
  for (const SourceCell& source : scenario.sources)
    regions[layout.of_cell(std::clamp(grid.column_of(source.x), 0, grid.columns - 1),
                           std::clamp(grid.row_of(source.y), 0, grid.rows - 1))] = true;
  return regions;
}

}  // namespace

std::vector<Map> make_maps(const Scenario& scenario, const Tally& tally) {
  RunCounts run = counts_of(scenario);
  run.thresholds = tally.thresholds();
  const Raster<float>& heights = scenario.surface.heights();
  const std::vector<bool> released = regions_of_sources(scenario);
  const auto quiet = std::make_shared<QuietRegions>(tally.grid(), [&](std::size_t region, const CellWindow& window) {
    return released[region] || tally.is_touched(region) ? Quiet::No : quiet_terrain(heights, window);
  });
  std::vector<Map> maps;
  for (const RunRaster& raster : run_rasters(scenario.output.count_rotation)) {
    Map map = raster.map;
    map.bands = bands_of(raster, run);
    if (map.bands.empty()) continue;
    const std::vector<double> untouched = untouched_values(raster, run, map.bands.size());
    if (raster.of_scenario) {
      map.fill = raster.of_scenario(scenario);
    } else {
      map.fill = filling({heights, tally, untouched, quiet}, [&raster, run] { return raster.rule(run); });
    }
    map.everywhere = quiet_values(quiet, untouched);
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace talus
