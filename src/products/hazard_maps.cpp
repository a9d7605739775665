#include "talus/products/hazard_maps.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/in_threads.hpp"

namespace talus {

HazardSurvey::HazardSurvey(const Grid& grid, HazardRules rules, HazardMatrix matrix, const ObjectWidth& object,
                           bool curves)
    : grid_(grid),
      rules_(std::move(rules)),
      matrix_(std::move(matrix)),
      object_(object),
      curves_(curves),
      seen_(std::max(object.width, std::sqrt(grid.cell_x * grid.cell_y))),
      maps_(hazard_maps_of(rules_, matrix_, object_, curves_)),
      rows_(static_cast<std::size_t>(grid.rows)),
      nothing_(object.width > 0.0 ? figures_of(std::vector<PassageDensity>(rules_.levels()), false)
                                  : figures_of({0, {}, false})) {}

std::vector<float> HazardSurvey::figures_of(const HazardPlace& place) const {
  std::vector<float> figures;
  for (const HazardMap& map : maps_) map.raster->figures(place, map.i, figures);
  return figures;
}

std::vector<float> HazardSurvey::figures_of(const HazardAt& at) const {
  const HazardCurve curve(rules_, at.cell);
  std::vector<Bounded> levels{curve.passage()};
  for (std::size_t i = 0; i + 1 < rules_.levels(); ++i) levels.push_back(curve.exceedance(i));
  return figures_of(HazardPlace{rules_, matrix_, at.exit, std::move(levels), &curve});
}

std::vector<float> HazardSurvey::figures_of(std::span<const PassageDensity> densities, bool exit) const {
  std::vector<Bounded> levels;
  for (const PassageDensity& density : densities)
    levels.push_back(hits_of_object(density, rules_.scale, object_.width, seen_));
  return figures_of(HazardPlace{rules_, matrix_, exit, std::move(levels)});
}

void HazardSurvey::set_row(int row, std::vector<bool> terrain, std::span<const HazardAt> cells, int threads) {
  Row& to = rows_[static_cast<std::size_t>(row)];
  to = {std::move(terrain), {}, {}, {}, {}};
  for (const HazardAt& at : cells) to.columns.push_back(at.column);
  if (object_.width > 0.0) {
    for (const HazardAt& at : cells) {
      to.exits.push_back(at.exit);
      std::vector<PassageDensity> levels = densities_of(at.cell, rules_.scale, grid_.cell_x * grid_.cell_y);
      levels.resize(rules_.levels());
      to.densities.insert(to.densities.end(), levels.begin(), levels.end());
    }
    return;
  }
  to.figures.resize(cells.size() * nothing_.size());
  in_parallel(cells.size(), threads, [&](std::size_t i) {
    const std::vector<float> figures = figures_of(cells[i]);
    std::ranges::copy(figures, to.figures.begin() + static_cast<std::ptrdiff_t>(i * figures.size()));
  });
}

/// The places of a row where an object is hit, with their figures: each has the mean density of the disc around it.
HazardSurvey::Row HazardSurvey::averaged(int row, std::span<const DiscCell> disc) const {
  const std::size_t levels = rules_.levels(), columns = static_cast<std::size_t>(grid_.columns);
  std::vector<PassageDensity> sums(columns * levels);
  std::vector<bool> hit(columns), exit(columns);
  for (const DiscCell& part : disc) {
    if (row + part.row < 0 || row + part.row >= grid_.rows) continue;
    const Row& from = rows_[static_cast<std::size_t>(row + part.row)];
    for (std::size_t k = 0; k < from.columns.size(); ++k) {
      const int column = from.columns[k] - part.column;
      if (column < 0 || column >= grid_.columns) continue;
      if (from.exits[k]) exit[static_cast<std::size_t>(column)] = true;
      if (!(from.densities[k * levels].length > 0.0)) continue;
      hit[static_cast<std::size_t>(column)] = true;
      for (std::size_t level = 0; level < levels; ++level) {
        PassageDensity& to = sums[static_cast<std::size_t>(column) * levels + level];
        const PassageDensity& add = from.densities[k * levels + level];
        to.length += part.share * add.length;
        to.by_diameter += part.share * add.by_diameter;
        to.squares += part.share * add.squares;
      }
    }
  }
  Row to;
  to.terrain = rows_[static_cast<std::size_t>(row)].terrain;
  for (std::size_t column = 0; column < to.terrain.size(); ++column) {
    if (!(hit[column] || exit[column]) || !to.terrain[column]) continue;
    to.columns.push_back(static_cast<int>(column));
    const std::vector<float> figures = figures_of({&sums[column * levels], levels}, exit[column]);
    to.figures.insert(to.figures.end(), figures.begin(), figures.end());
  }
  return to;
}

void HazardSurvey::finish(int threads) {
  if (!(object_.width > 0.0)) return;
  const std::vector<DiscCell> parts = disc(object_.width, grid_.cell_x, grid_.cell_y);
  std::vector<Row> places(rows_.size());
  in_parallel(rows_.size(), threads, [&](std::size_t row) { places[row] = averaged(static_cast<int>(row), parts); });
  rows_ = std::move(places);
}

std::uint64_t HazardSurvey::cells() const {
  std::uint64_t sum = 0;
  for (const Row& row : rows_) sum += row.columns.size();
  return sum;
}

void HazardSurvey::fill(const CellWindow& window, std::size_t first, std::size_t count,
                        std::span<double> values) const {
  const int end = window.column + window.columns;
  std::size_t place = 0;  // of the first cell of a row
  for (int row = window.row; row < window.row + window.rows; ++row, place += static_cast<std::size_t>(window.columns)) {
    const Row& from = rows_[static_cast<std::size_t>(row)];
    const auto value = [&](std::size_t i, int column) -> double& {
      return values[(place + static_cast<std::size_t>(column - window.column)) * count + i];
    };
    for (int column = window.column; column < end; ++column)
      for (std::size_t i = 0; i < count; ++i)
        value(i, column) = from.has_terrain(column) ? double{nothing_[first + i]} : kNotGiven;
    for (std::size_t k = from.first_from(window.column); k < from.columns.size() && from.columns[k] < end; ++k)
      for (std::size_t i = 0; i < count; ++i) value(i, from.columns[k]) = from.figures[k * nothing_.size() + first + i];
  }
}

Quiet HazardSurvey::quiet(const CellWindow& window) const {
  std::size_t terrain = 0;
  for (int row = window.row; row < window.row + window.rows; ++row) {
    const Row& of = rows_[static_cast<std::size_t>(row)];
    const std::size_t k = of.first_from(window.column);
    if (k < of.columns.size() && of.columns[k] < window.column + window.columns) return Quiet::No;
    for (int column = window.column; column < window.column + window.columns; ++column)
      terrain += of.has_terrain(column) ? 1U : 0U;
  }
  return quiet_of(terrain, window);
}

std::optional<std::vector<double>> HazardSurvey::everywhere(Quiet quiet, std::size_t first, std::size_t count) const {
  if (quiet == Quiet::No) return std::nullopt;
  std::vector<double> values(count, kNotGiven);
  if (quiet == Quiet::Terrain) std::copy_n(&nothing_[first], count, values.begin());
  return values;
}

std::vector<Map> make_hazard_maps(const HazardSurvey& survey) {
  const auto quiet = std::make_shared<QuietRegions>(
      survey.grid(), [&survey](std::size_t, const CellWindow& region) { return survey.quiet(region); });
  std::vector<Map> maps;
  std::size_t next = 0;
  for (HazardMap& of : hazard_maps_of(survey.rules(), survey.matrix(), survey.object(), survey.curves())) {
    const std::size_t first = next, count = of.map.bands.size();
    next += count;
    of.map.fill = [&survey, first, count](const CellWindow& window, std::span<double> values) {
      survey.fill(window, first, count, values);
    };
    of.map.everywhere = [&survey, quiet, first, count](const CellWindow& window) {
      return survey.everywhere(quiet->of(window), first, count);
    };
    maps.push_back(std::move(of.map));
  }
  return maps;
}

}  // namespace talus
