#include "talus/products/hazard_maps.hpp"

#include <omp.h>

#include <algorithm>
#include <exception>

namespace talus {
HazardSurvey::HazardSurvey(const Grid& grid, HazardRules rules, HazardMatrix matrix)
    : grid_(grid),
      rules_(std::move(rules)),
      matrix_(std::move(matrix)),
      maps_(hazard_maps_of(rules_, matrix_)),
      rows_(static_cast<std::size_t>(grid.rows)),
      nothing_(figures_of({0, {}, false})) {}

std::vector<float> HazardSurvey::figures_of(const HazardAt& at) const {
  const HazardCurve curve(rules_, at.cell);
  std::vector<float> figures;
  for (const HazardMap& map : maps_) map.raster->figures({curve, matrix_, at.exit}, map.i, figures);
  return figures;
}

// An exception must not leave the parallel region: the first one is stored, and thrown again after the region.
void HazardSurvey::set_row(int row, std::vector<bool> terrain, std::span<const HazardAt> cells, int threads) {
  Row& to = rows_[static_cast<std::size_t>(row)];
  to = {std::move(terrain), {}, std::vector<float>(cells.size() * nothing_.size())};
  for (const HazardAt& cell : cells) to.columns.push_back(cell.column);
  const auto evaluate = [&](std::size_t i) {
    const std::vector<float> figures = figures_of(cells[i]);
    std::ranges::copy(figures, to.figures.begin() + static_cast<std::ptrdiff_t>(i * figures.size()));
  };
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic, 8) num_threads(threads > 0 ? threads : omp_get_num_procs()) default(none) \
    shared(cells, evaluate, failure)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    try {
      evaluate(i);
    } catch (...) {
#pragma omp critical
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

std::uint64_t HazardSurvey::cells() const {
  std::uint64_t sum = 0;
  for (const Row& row : rows_) sum += row.columns.size();
  return sum;
}

void HazardSurvey::fill(int row, std::size_t first, std::size_t count, std::span<double> values) const {
  const Row& from = rows_[static_cast<std::size_t>(row)];
  const auto columns = static_cast<std::size_t>(grid_.columns);
  for (std::size_t column = 0; column < columns; ++column) {
    const bool terrain = column < from.terrain.size() && from.terrain[column];
    for (std::size_t i = 0; i < count; ++i)
      values[i * columns + column] = terrain ? double{nothing_[first + i]} : kNotGiven;
  }
  for (std::size_t k = 0; k < from.columns.size(); ++k)
    for (std::size_t i = 0; i < count; ++i)
      values[i * columns + static_cast<std::size_t>(from.columns[k])] = from.figures[k * nothing_.size() + first + i];
}

std::vector<Map> make_hazard_maps(const HazardSurvey& survey) {
  std::vector<Map> maps;
  std::size_t next = 0;
  for (HazardMap& of : hazard_maps_of(survey.rules(), survey.matrix())) {
    const std::size_t first = next, count = of.map.bands.size();
    next += count;
    of.map.fill_row = [&survey, first, count](int row, std::span<double> values) {
      survey.fill(row, first, count, values);
    };
    maps.push_back(std::move(of.map));
  }
  return maps;
}

}  // namespace talus
