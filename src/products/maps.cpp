#include "talus/products/maps.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>

namespace talus {
namespace {

/// Writes the values of one touched cell; `values` has one number per band.
using CellValues = std::function<void(const CellRecord&, const std::uint32_t* exceedances, std::span<double> values)>;

/// Rows of a map from a rule for touched cells and a value for cells that nothing crosses.
auto rows_of(const Scenario& scenario, const Tally& tally, std::size_t bands, double untouched, CellValues rule) {
  return [&scenario, &tally, bands, untouched, rule = std::move(rule)](int row, std::span<double> values) {
    const Grid& grid = tally.grid();
    const auto columns = static_cast<std::size_t>(grid.columns);
    std::vector<double> cell(bands);
    for (int column = 0; column < grid.columns; ++column) {
      if (column % kRegionSide == 0) tally.memory().keep_below_limit();  // a record in the file brings its neighbours
      const CellRecord* record = tally.find(column, row);
      const bool terrain = !std::isnan(scenario.surface.heights().at(column, row));
      if (record != nullptr)
        rule(*record, tally.exceedances(column, row), cell);
      else
        std::fill(cell.begin(), cell.end(), terrain ? untouched : kNotGiven);
      for (std::size_t band = 0; band < bands; ++band)
        values[band * columns + static_cast<std::size_t>(column)] = cell[band];
    }
  };
}

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

Map count_map(const Scenario& scenario, const Tally& tally, const std::string& name, const std::string& title,
              std::function<double(const CellRecord&)> count) {
  return {name,
          title,
          Map::Kind::Count,
          {{name, "count"}},
          rows_of(scenario, tally, 1, 0.0,
                  [count = std::move(count)](const CellRecord& cell, const std::uint32_t*, std::span<double> values) {
                    values[0] = count(cell);
                  })};
}

Map quantity_map(const Scenario& scenario, const Tally& tally, Quantity quantity, const std::string& name,
                 const std::string& title, const std::string& unit) {
  const auto rule = [quantity](const CellRecord& cell, const std::uint32_t*, std::span<double> values) {
    const auto q = static_cast<std::size_t>(quantity);
    const double maximum = cell.maximum[q];
    values[0] = std::min(maximum, cell.mean(quantity));
    values[1] = std::min(maximum, cell.histogram[q].percentile(0.50));
    values[2] = std::min(maximum, cell.histogram[q].percentile(0.95));
    values[3] = std::min(maximum, cell.histogram[q].percentile(0.99));
    values[4] = maximum;
  };
  return {name,
          title,
          Map::Kind::Quantity,
          {{"mean", unit}, {"P50", unit}, {"P95", unit}, {"P99", unit}, {"maximum", unit}},
          rows_of(scenario, tally, 5, kNotGiven, rule)};
}

Map impact_probability(const Scenario& scenario, const Tally& tally) {
  const std::uint64_t released = scenario.released();
  auto known = std::make_shared<std::unordered_map<std::uint32_t, Interval>>();  // many cells have the same count
  const auto rule = [released, known](const CellRecord& cell, const std::uint32_t*, std::span<double> values) {
    const auto [it, fresh] = known->try_emplace(cell.passages);
    if (fresh) it->second = probability_bounds(cell.passages, released, 0.95);
    values[0] = static_cast<double>(cell.passages) / static_cast<double>(released);
    values[1] = it->second.low;
    values[2] = it->second.high;
  };
  // Where no path was, the probability is 0 and so is its lower bound; the upper bound is that of no hit in all trials.
  auto rows = rows_of(scenario, tally, 3, 0.0, rule);
  const double none = probability_bounds(0, released, 0.95).high;
  const auto fill = [rows, none, &tally](int row, std::span<double> values) {
    rows(row, values);
    const auto columns = static_cast<std::size_t>(tally.grid().columns);
    for (std::size_t c = 0; c < columns; ++c)
      if (values[c] == 0.0) values[2 * columns + c] = none;
  };
  return {"impact_probability",
          "Fraction of all released trajectories whose path crosses the cell",
          Map::Kind::Probability,
          {{"probability", "1"}, {"lower 95 % bound", "1"}, {"upper 95 % bound", "1"}},
          fill};
}

Map reach_probability(const Scenario& scenario, const Tally& tally) {
  const double per_source = scenario.trajectories;
  return {"reach_probability",
          "Fraction of the trajectories of those source cells of which at least one trajectory reaches the cell",
          Map::Kind::Probability,
          {{"reach probability", "1"}},
          rows_of(scenario, tally, 1, 0.0,
                  [per_source](const CellRecord& cell, const std::uint32_t*, std::span<double> values) {
                    values[0] = cell.passages / (cell.sources * per_source);
                  })};
}

Map exceedance(const Scenario& scenario, const Tally& tally, const std::string& name, const std::string& title,
               std::size_t first, const std::vector<double>& thresholds, const std::string& symbol,
               const std::string& unit) {
  const auto released = static_cast<double>(scenario.released());
  Map map{name, title, Map::Kind::Probability, {}, {}, false, {}};
  for (const double threshold : thresholds)
    map.bands.push_back({"P(" + symbol + " > " + number(threshold) + " " + unit + ")", "1"});
  map.fill_row = rows_of(scenario, tally, thresholds.size(), 0.0,
                         [first, released](const CellRecord&, const std::uint32_t* over, std::span<double> values) {
                           for (std::size_t i = 0; i < values.size(); ++i) values[i] = over[first + i] / released;
                         });
  return map;
}

}  // namespace

std::vector<Map> make_maps(const Scenario& scenario, const Tally& tally) {
  std::vector<Map> maps{impact_probability(scenario, tally), reach_probability(scenario, tally)};
  if (!tally.energy_thresholds().empty())
    maps.push_back(exceedance(scenario, tally, "energy_exceedance",
                              "Fraction of all released trajectories whose translational kinetic energy in the cell "
                              "exceeds the threshold",
                              0, tally.energy_thresholds(), "E", "kJ"));
  if (!tally.height_thresholds().empty())
    maps.push_back(exceedance(scenario, tally, "height_exceedance",
                              "Fraction of all released trajectories whose height above the terrain in the cell "
                              "exceeds the threshold",
                              tally.energy_thresholds().size(), tally.height_thresholds(), "h", "m"));
  maps.push_back(quantity_map(scenario, tally, Quantity::Energy, "energy", "Translational kinetic energy", "kJ"));
  maps.push_back(quantity_map(scenario, tally, Quantity::Speed, "velocity", "Speed", "m/s"));
  maps.push_back(quantity_map(scenario, tally, Quantity::Height, "jump_height", "Vertical height above terrain", "m"));
  maps.push_back(count_map(scenario, tally, "passages", "Trajectories that cross the cell",
                           [](const CellRecord& c) { return static_cast<double>(c.passages); }));
  maps.push_back(count_map(scenario, tally, "impacts", "Impacts in the cell",
                           [](const CellRecord& c) { return static_cast<double>(c.impacts); }));
  maps.push_back(count_map(scenario, tally, "deposits", "Trajectories that stop in the cell, or are caught there",
                           [](const CellRecord& c) { return static_cast<double>(c.deposits); }));
  maps.push_back(count_map(scenario, tally, "sources", "Source cells that reach the cell",
                           [](const CellRecord& c) { return static_cast<double>(c.sources); }));
  return maps;
}

}  // namespace talus
