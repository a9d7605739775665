#include "talus/products/hazard_maps.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "talus/base/text.hpp"

namespace talus {
namespace {

void push(std::vector<float>& figures, const Bounded& bounded) {
  for (const double value : {bounded.value, bounded.low, bounded.high})
    figures.push_back(static_cast<float>(std::isfinite(value) ? value : kNotGiven));
}

std::vector<Map::Band> bounded_bands(const std::string& name, const std::string& unit) {
  return {{name, unit}, {"lower 95 % bound", unit}, {"upper 95 % bound", unit}};
}

}  // namespace

HazardSurvey::HazardSurvey(const Grid& grid, HazardRules rules, HazardMatrix matrix)
    : grid_(grid),
      rules_(std::move(rules)),
      matrix_(std::move(matrix)),
      rows_(static_cast<std::size_t>(grid.rows)),
      nothing_(figures_of({})) {}

std::vector<float> HazardSurvey::figures_of(const HazardCell& cell) const {
  const HazardCurve curve(rules_, cell);
  std::vector<float> figures;
  push(figures, curve.passage());
  for (std::size_t i = 0; i < rules_.bins.thresholds().size(); ++i) push(figures, return_period(curve.exceedance(i)));
  for (const double years : matrix_.years) push(figures, curve.energy_once_in(years));
  std::vector<Bounded> frequencies{curve.passage()};
  for (const double energy : matrix_.energies) frequencies.push_back(curve.exceedance_of(energy));
  const auto side = [&](double Bounded::*member) {
    std::vector<double> values;
    for (const Bounded& f : frequencies) values.push_back(f.*member);
    return values;
  };
  const std::vector<double> low = side(&Bounded::low), high = side(&Bounded::high);
  const int here = class_of(matrix_, side(&Bounded::value)), highest = class_of(matrix_, high, false);
  for (const int figure : {here, class_of(matrix_, low), std::max(here, highest),
                           static_cast<int>(class_of(matrix_, low, false) != highest)})
    figures.push_back(static_cast<float>(figure));
  return figures;
}

// What is thrown may not leave the parallel region: the first failure is kept.
void HazardSurvey::set_row(int row, std::vector<bool> terrain, std::span<const Cell> cells, int threads) {
  Row& to = rows_[static_cast<std::size_t>(row)];
  to = {std::move(terrain), {}, std::vector<float>(cells.size() * nothing_.size())};
  for (const Cell& cell : cells) to.columns.push_back(cell.first);
  const auto evaluate = [&](std::size_t i) {
    const std::vector<float> figures = figures_of(cells[i].second);
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
  const auto add = [&](const std::string& name, const std::string& title, Map::Kind kind,
                       std::vector<Map::Band> bands) -> Map& {
    const std::size_t first = next, count = bands.size();
    next += count;
    return maps.emplace_back(
        Map{name,
            title,
            kind,
            std::move(bands),
            [&survey, first, count](int row, std::span<double> values) { survey.fill(row, first, count, values); },
            false,
            {}});
  };
  constexpr auto kQuantity = Map::Kind::Quantity;
  add("annual_frequency", "Trajectories that pass the cell in a year", kQuantity,
      bounded_bands("annual frequency", "1/year"));
  for (const double energy : survey.rules().bins.thresholds())
    add("return_period_" + text_of(energy),
        "Years between trajectories that exceed " + text_of(energy) + " kJ in the cell", kQuantity,
        bounded_bands("return period of E > " + text_of(energy) + " kJ", "years"))
        .smallest_in_overviews = true;
  for (const double years : survey.matrix().years)
    add("intensity_T" + text_of(years),
        "Translational kinetic energy that is exceeded once in " + text_of(years) + " years in the cell", kQuantity,
        bounded_bands("energy once in " + text_of(years) + " years", "kJ"));
  add("hazard_class", "Class of hazard by intensity and return period", Map::Kind::Count,
      {{"class", "class"}, {"class at lower bound", "class"}, {"class at upper bound", "class"}, {"undecided", "1"}})
      .classes = survey.matrix().names;
  return maps;
}

}  // namespace talus
