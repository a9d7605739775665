#include "talus/products/raster_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <unordered_map>

#include "raster_parts.hpp"
#include "talus/base/text.hpp"
#include "talus/products/energy_words.hpp"
#include "talus/products/interval.hpp"
#include "talus/products/passage_bounds.hpp"
#include "talus/products/percentile_bounds.hpp"
#include "talus/products/release_cells.hpp"

namespace talus {
namespace {

using Kind = Map::Kind;

constexpr const char* kUpperP95 = "P95 upper 95 % bound";

Legend percent_legend() {
  return {{1e-4, 1e-3, 1e-2, 1e-1, 1.0}, 100.0, "%", Palette::Plasma};
}

/// A reach probability is at least 1 / trajectories of a source cell: its classes begin where those of impacts end.
Legend reach_legend() {
  return {{0.02, 0.05, 0.1, 0.2, 0.5, 1.0}, 100.0, "%", Palette::Plasma};
}

Legend speed_legend(const std::string& band) {
  return {{5, 10, 15, 20, 30}, 1.0, "m/s", Palette::Viridis, band};
}

Legend height_legend(const std::string& band) {
  return {{0.5, 1, 2, 4, 8}, 1.0, "m", Palette::Viridis, band};
}

Legend count_legend() {
  return {{1, 10, 100, 1000, 10000}, 1.0, "", Palette::YlGnBu};
}

/// Plan length per area and released block, with bounds; then above each energy threshold.
CellRule passage_density(const RunCounts& run) {
  const double longest = std::hypot(run.cell_x, run.cell_y), area = run.cell_x * run.cell_y;
  const auto released = static_cast<double>(run.released);
  return [=](const TouchedCell& cell, std::span<double> values) {
    constexpr double kUnit = CellRecord::kLengthUnit;
    const Bounded length = mean_length(static_cast<double>(cell.record.length) * kUnit,
                                       static_cast<double>(cell.record.length_squares) * kUnit, longest, released);
    values[0] = length.value / area;
    values[1] = length.low / area;
    values[2] = length.high / area;
    for (std::size_t i = 3; i < values.size(); ++i)
      values[i] = static_cast<double>(cell.lengths_above[i - 3]) * kUnit / (area * released);
  };
}

/// If nothing crosses, the upper bound is that of 3.7 blocks straight through the cell.
std::vector<double> no_passage(const RunCounts& run) {
  std::vector<double> values(3 + run.thresholds[Quantity::Energy].size());
  const double area = run.cell_x * run.cell_y;
  values[2] = mean_length(0.0, 0.0, std::hypot(run.cell_x, run.cell_y), static_cast<double>(run.released)).high / area;
  return values;
}

/// Values of a function that is expensive and often called again with the same argument.
template <class Value>
class Remembered {
 public:
  template <class Function>
  const Value& of(std::uint64_t argument, Function&& function) {
    if (values_.size() >= kMost) values_.clear();
    const auto [it, fresh] = values_.try_emplace(argument);
    if (fresh) it->second = function();
    return it->second;
  }

 private:
  static constexpr std::size_t kMost = 100'000;
  std::unordered_map<std::uint64_t, Value> values_;
};

CellRule impact_probability(const RunCounts& run) {
  const std::uint64_t released = run.released;
  auto remembered = std::make_shared<Remembered<Interval>>();
  return [released, remembered](const TouchedCell& cell, std::span<double> values) {
    const std::uint32_t passages = cell.record.passages;
    const Interval& bounds =
        remembered->of(passages, [&] { return probability_bounds(passages, released, kConfidence); });
    values[0] = static_cast<double>(passages) / static_cast<double>(released);
    values[1] = bounds.low;
    values[2] = bounds.high;
  };
}

/// If nothing crosses, the upper bound is that of no hit in all trials.
std::vector<double> no_impact(const RunCounts& run) {
  return {0.0, 0.0, probability_bounds(0, run.released, kConfidence).high};
}

/// If nothing crosses, the upper bound is that of one source cell without a hit.
std::vector<double> not_reached(const RunCounts& run) {
  return {0.0, 0.0, probability_bounds(0, static_cast<std::uint64_t>(run.per_source), kConfidence).high};
}

CellRule reach_probability(const RunCounts& run) {
  auto remembered = std::make_shared<Remembered<Interval>>();
  return [per_source = run.per_source, remembered](const TouchedCell& cell, std::span<double> values) {
    const std::uint64_t passages = cell.record.passages, sources = cell.record.sources;
    const Interval& bounds = remembered->of(sources << 32U | passages, [&] {
      return bounds_of_reached(passages, sources, static_cast<std::uint64_t>(per_source));
    });
    values[0] = cell.record.passages / (cell.record.sources * per_source);
    values[1] = bounds.low;
    values[2] = bounds.high;
  };
}

/// A raster of the share of trajectories that exceed each threshold of a quantity.
RunRaster exceedance(Quantity quantity, const std::string& name, const std::string& what, const std::string& symbol) {
  const auto rule = [quantity](const RunCounts& run) -> CellRule {
    std::size_t first = 0;
    for (std::size_t q = 0; q < index_of(quantity); ++q) first += run.thresholds[q].size();
    auto remembered = std::make_shared<Remembered<Interval>>();
    return [first, remembered, released = run.released](const TouchedCell& cell, std::span<double> values) {
      const std::size_t thresholds = values.size() / 3;
      for (std::size_t i = 0; i < thresholds; ++i) {
        const std::uint32_t hits = cell.exceedances[first + i];
        const Interval& bounds = remembered->of(hits, [&] { return probability_bounds(hits, released, kConfidence); });
        values[i] = hits / static_cast<double>(released);
        values[thresholds + 2 * i] = bounds.low;
        values[thresholds + 2 * i + 1] = bounds.high;
      }
    };
  };
  const auto untouched = [quantity](const RunCounts& run) {
    const std::size_t thresholds = run.thresholds[quantity].size();
    std::vector<double> values(3 * thresholds);
    for (std::size_t i = 0; i < thresholds; ++i)
      values[thresholds + 2 * i + 1] = probability_bounds(0, run.released, kConfidence).high;
    return values;
  };
  return {.map = {name,
                  "Fraction of all released trajectories whose " + what +
                      " in the cell exceeds the threshold (in plan, at any height)",
                  Kind::Probability,
                  {},
                  percent_legend()},
          .meaning = "share of N whose " + what + " exceeds the threshold",
          .rule = rule,
          .untouched = untouched,
          .thresholds_of = quantity,
          .threshold_band = "P(" + symbol + " > <limit>)",
          .threshold_bounds = true};
}

/// Mean, percentiles and maximum of the values of a cell.
void put_distribution(double mean, const LogHistogram& histogram, double maximum, std::span<double> values) {
  constexpr std::array kShares{0.50, 0.95, 0.99};
  histogram.percentiles(kShares, values.subspan(1, kShares.size()));
  values[0] = mean;
  for (double& value : values.first(4)) value = std::min(maximum, value);
  values[4] = maximum;
}

std::vector<Map::Band> distribution_bands(const std::string& unit) {
  return {{"mean", unit}, {"P50", unit}, {"P95", unit}, {"P99", unit}, {"maximum", unit}};
}

/// A raster of the distribution of a quantity over the trajectories.
RunRaster distribution(Quantity quantity, const std::string& meaning, Legend legend) {
  const QuantityEntry& entry = kQuantityTable[index_of(quantity)];
  const std::string unit(entry.unit);
  const auto rule = [quantity](const RunCounts&) -> CellRule {
    return [quantity](const TouchedCell& cell, std::span<double> values) {
      put_distribution(cell.record.mean(quantity), cell.record.histogram[quantity], cell.record.maximum[quantity],
                       values);
    };
  };
  return {
      {std::string(entry.name), std::string(entry.title), Kind::Quantity, distribution_bands(unit), std::move(legend)},
      meaning,
      rule};
}

/// The raster of the energy with rotation.
RunRaster energy_total() {
  const auto rule = [](const RunCounts&) -> CellRule {
    return [](const TouchedCell& cell, std::span<double> values) {
      const EnergyTotal& total = *cell.energy_total;
      put_distribution(total.mean(), total.histogram, total.maximum, values);
    };
  };
  return {.map = {"energy_total", "Kinetic energy, translation and rotation", Kind::Quantity, distribution_bands("kJ"),
                  energy_legend("P95")},
          .meaning = "translational and rotational",
          .rule = rule,
          .request = &RunCounts::energy_total};
}

/// A raster of the bounds of the percentiles of a quantity.
RunRaster percentile_bounds_of(Quantity quantity, Legend legend) {
  constexpr std::array kShares{0.50, 0.95, 0.99};
  const QuantityEntry& entry = kQuantityTable[index_of(quantity)];
  const std::string unit(entry.unit);
  std::vector<Map::Band> bands;
  for (const char* const name : {"P50", "P95", "P99"})
    for (const char* const side : {" lower 95 % bound", " upper 95 % bound"})
      bands.push_back({std::string(name) + side, unit});
  const auto rule = [quantity, kShares](const RunCounts&) -> CellRule {
    auto remembered = std::make_shared<Remembered<std::array<Ranks, 3>>>();
    return [=](const TouchedCell& cell, std::span<double> values) {
      const std::uint64_t n = cell.record.passages;
      const auto& ranks = remembered->of(n, [&] {
        return std::array{percentile_ranks(n, kShares[0]), percentile_ranks(n, kShares[1]),
                          percentile_ranks(n, kShares[2])};
      });
      for (std::size_t i = 0; i < kShares.size(); ++i) {
        const Interval bounds =
            percentile_bounds(cell.record.histogram[quantity], ranks[i], cell.record.maximum[quantity]);
        values[2 * i] = bounds.low;
        values[2 * i + 1] = bounds.high;
      }
    };
  };
  const std::string name(entry.name);
  return {.map = {name + "_bounds", std::string(entry.title) + ": 95 % bounds of the percentiles", Kind::Quantity,
                  std::move(bands), std::move(legend)},
          .meaning = "95 % bounds of the percentiles of `" + name + ".tif`",
          .rule = rule,
          .request = &RunCounts::bounds};
}

/// A raster of one of the counts of the cell record.
template <class Count>
RunRaster count(const std::string& name, const std::string& title, const std::string& meaning, Legend legend,
                Count CellRecord::*member) {
  const auto rule = [member](const RunCounts&) -> CellRule {
    return [member](const TouchedCell& cell, std::span<double> values) {
      values[0] = static_cast<double>(cell.record.*member);
    };
  };
  return {{name, title, Kind::Count, {{name, "count"}}, std::move(legend)}, meaning, rule};
}

/// The raster of the release cells.
RunRaster release() {
  const auto cells = [](const Scenario& scenario) {
    return [cells = ReleaseCells(scenario)](const CellWindow& window, std::span<double> values) {
      cells.fill(window, values);
    };
  };
  RunRaster raster{{"release",
                    "Trajectories released from the cell: the sources as the run took them",
                    Kind::Count,
                    {{"released", "count"}},
                    count_legend()},
                   "trajectories released from the cell",
                   {}};
  raster.of_scenario = cells;
  return raster;
}

std::vector<RunRaster> make_run_rasters(const EnergyWords& energy) {
  return {
      {{"impact_probability",
        "Fraction of all released trajectories whose path crosses the cell (in plan, at any height)", Kind::Probability,
        bounded_bands("probability (in plan, at any height)", "1"), percent_legend()},
       "share of N whose path crosses the cell",
       impact_probability,
       no_impact},
      {{"reach_probability",
        "Fraction of the trajectories of those source cells of which at least one trajectory reaches the cell "
        "(in plan, at any height)",
        Kind::Probability, bounded_bands("reach probability (in plan, at any height)", "1"), reach_legend()},
       "share of the trajectories of the source cells of which at least one trajectory reaches the cell",
       reach_probability,
       not_reached},
      exceedance(Quantity::Energy, "energy_exceedance", energy.noun, energy.symbol),
      exceedance(Quantity::Height, "height_exceedance", "height above the terrain", "h"),
      {.map = {"passage_density",
               "Mean number of passages of a line 1 m wide per released block: plan length of the paths / (area of the "
               "cell x released blocks)",
               Kind::Quantity,
               bounded_bands("passage density (in plan, at any height)", "1/m"),
               {{1e-6, 1e-5, 1e-4, 1e-3, 1e-2}, 1.0, "1/m", Palette::Plasma}},
       .meaning = "plan length of the paths in the cell / (area of the cell x released blocks)",
       .rule = passage_density,
       .untouched = no_passage,
       .thresholds_of = Quantity::Energy,
       .threshold_band = "passage density of " + energy.symbol + " > <limit> (in plan, at any height)",
       .counts_lengths = true},
      distribution(Quantity::Energy, "translational", energy_legend("P95")),
      energy_total(),
      distribution(Quantity::Speed, "in space", speed_legend("P95")),
      distribution(Quantity::Height, "vertical, terrain to the block's lowest point; 0 while sliding",
                   height_legend("P95")),
      percentile_bounds_of(Quantity::Energy, energy_legend(kUpperP95)),
      percentile_bounds_of(Quantity::Speed, speed_legend(kUpperP95)),
      percentile_bounds_of(Quantity::Height, height_legend(kUpperP95)),
      count("passages", "Trajectories that cross the cell", "trajectories that cross the cell", count_legend(),
            &CellRecord::passages),
      count("impacts", "Impacts in the cell", "impacts in the cell, all bounces of all trajectories", count_legend(),
            &CellRecord::impacts),
      count("deposits", "Trajectories that stop in the cell, or are trapped or caught there",
            "trajectories that stop in the cell, or are trapped or caught there", count_legend(),
            &CellRecord::deposits),
      count("trapped", "Trajectories that are trapped in the cell, in a pit or between walls",
            "trajectories that are trapped in the cell; `deposits` counts them too", count_legend(),
            &CellRecord::trapped),
      count("exits", "Trajectories that leave the DEM, or meet missing data, from the cell",
            "trajectories that leave the DEM, or meet missing data, from the cell: the last one that they cross",
            count_legend(), &CellRecord::exits),
      release(),
      count("sources", "Source cells that reach the cell",
            "source cells of which at least one trajectory reaches the cell",
            {{1, 3, 10, 30, 100}, 1.0, "", Palette::YlGnBu}, &CellRecord::sources),
  };
}

}  // namespace

RunCounts counts_of(const Scenario& scenario) {
  return {scenario.released(),
          static_cast<double>(scenario.trajectories),
          thresholds_of(scenario.output.energy_thresholds, scenario.output.height_thresholds),
          scenario.surface.grid().cell_x,
          scenario.surface.grid().cell_y,
          scenario.output.passages_below,
          scenario.output.keeps_total(),
          scenario.output.bounds};
}

const std::vector<RunRaster>& run_rasters(bool with_rotation) {
  static const std::vector<RunRaster> translational = make_run_rasters(energy_words(false));
  static const std::vector<RunRaster> total = make_run_rasters(energy_words(true));
  return with_rotation ? total : translational;
}

std::vector<Map::Band> bands_of(const RunRaster& raster, const RunCounts& run) {
  if (raster.request != nullptr && !(run.*raster.request)) return {};
  std::vector<Map::Band> bands = raster.map.bands;
  if (raster.thresholds_of) {
    const std::string unit(kQuantityTable[index_of(*raster.thresholds_of)].unit);
    const std::string band_unit = bands.empty() ? "1" : bands.front().unit;
    for (const double threshold : run.thresholds[*raster.thresholds_of])
      bands.push_back({replaced(raster.threshold_band, "<limit>", text_of(threshold) + " " + unit), band_unit});
  }
  if (raster.threshold_bounds) {
    const std::vector<Map::Band> values = bands;
    for (const Map::Band& band : values)
      for (const char* const side : {" lower 95 % bound", " upper 95 % bound"})
        bands.push_back({band.name + side, band.unit});
  }
  if (raster.counts_lengths)
    for (Map::Band& band : bands) band.name = with_height(band.name, run.passages_below);
  return bands;
}

}  // namespace talus
