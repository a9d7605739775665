#include "talus/physics/effects/forest_stems.hpp"

#include <algorithm>
#include <cmath>

#include "talus/physics/flight.hpp"

namespace talus {
namespace {

constexpr double kReached = 1e-7;  // distance from a tree of a list that counts as reached [m]

const Grid& grid_of(const ForestMap& map) {
  return map.density.values.empty() ? map.diameter.grid : map.density.grid;
}

/// Calls visit(stand, from, to) for the parts of a way that have one stand each [m], in order, until it returns false.
/// Cells with the same stand make one part, so that equal cells act like one stand of the same
/// (32-bit) numbers, bit for bit.
template <class Visit>
void for_each_stand(const ForestStems& forest, const PlanWay& way, Visit visit) {
  const Grid& grid = grid_of(*forest.map);
  int column = grid.column_of(way.from.x()), row = grid.row_of(way.from.y());
  const int east = way.heading.x() < 0.0 ? -1 : 1, north = way.heading.y() < 0.0 ? -1 : 1;
  const auto line = [](double place, double heading, double cell, int index, int step) {
    return heading == 0.0 ? kNever : ((index + (step > 0 ? 1 : 0)) * cell - place) / heading;
  };
  Stand stand = stand_in(forest, column, row);
  double from = 0.0;
  for (int crossed = 0; crossed <= grid.columns + grid.rows + 2; ++crossed) {
    const double to_column = line(way.from.x(), way.heading.x(), grid.cell_x, column, east);
    const double to_row = line(way.from.y(), way.heading.y(), grid.cell_y, row, north);
    const double at = std::min(to_column, to_row);
    if (!(at < way.length)) break;
    (to_column <= to_row ? column : row) += to_column <= to_row ? east : north;
    const Stand next = stand_in(forest, column, row);
    if (next == stand) continue;
    if (!visit(stand, from, std::max(from, at))) return;
    stand = next, from = std::max(from, at);
  }
  visit(stand, from, way.length);
}

}  // namespace

Stand stand_in(const ForestStems& forest, int column, int row) {
  Stand stand{forest.density, forest.diameter};
  if (!forest.by_cell()) return stand;
  const ForestMap& map = *forest.map;
  if (!grid_of(map).contains(column, row)) return {0.0, forest.diameter};
  if (!map.density.values.empty()) stand.density = map.density.at(column, row);
  if (!map.diameter.values.empty()) stand.diameter = map.diameter.at(column, row);
  return stand;
}

bool has_stand(const ForestStems& forest, std::uint8_t zone, double x, double y) {
  if (!forest.where.covers(zone, x, y)) return false;
  if (!forest.by_cell()) return true;
  const Grid& grid = grid_of(*forest.map);
  return stand_in(forest, grid.column_of(x), grid.row_of(y)).density > 0.0;
}

double stem_capacity(double diameter, double factor) {
  return factor * 38.7 * power(100.0 * diameter, 2.31);
}

double stem_share(double eccentricity) {
  constexpr double kLn10 = 2.302585092994046;
  const double away = exponential(kLn10 * -8.007 * (0.58 - std::abs(eccentricity)));
  return std::max(0.0, -0.046 + 1.026 / (1.0 + away));
}

Vec3 velocity_after_stem(const Vec3& velocity, double taken, double eccentricity) {
  const double speed_squared = velocity.squaredNorm();
  if (!(speed_squared > 0.0)) return velocity;
  const double left = std::max(0.0, 1.0 - 2.0 * taken / speed_squared);  // share of v^2
  const double across = eccentricity, towards = std::sqrt(1.0 - across * across);
  const double towards_after = std::sqrt(std::max(0.0, towards * towards - (1.0 - left)));
  const double length = std::sqrt(across * across + towards_after * towards_after);
  if (!(length > 0.0)) return Vec3::Zero();
  // Angle between the directions (towards, across) before and (towards_after, across) after.
  const double cosine = (towards * towards_after + across * across) / length;
  const double sine = across * (towards - towards_after) / length;
  const double kept = std::sqrt(left);
  return {kept * (cosine * velocity.x() + sine * velocity.y()), kept * (cosine * velocity.y() - sine * velocity.x()),
          kept * velocity.z()};
}

Stems::Stems(const ForestStems& forest, const Random& random)
    : forest_(forest), random_(random), capacity_(stem_capacity(forest.diameter, forest.species_factor)) {
  if (!of_list()) draw();
}

void Stems::draw() {
  const Words words = random_.words(number_++);
  left_ = -natural_log(uniform(words[0]));
  eccentricity_ = 2.0 * uniform(words[1]) - 1.0;
}

double Stems::way_left(const PlanWay& ahead, double diameter) {
  if (of_list()) {
    ahead_ = forest_.map->trees.first_on(ahead, diameter, touched_);
    return ahead_ ? ahead_->way : kNever;
  }
  double left = std::max(0.0, left_);
  if (!forest_.by_cell()) return left * mean_free_path({forest_.density, forest_.diameter}, diameter);
  double way = kNever;
  for_each_stand(forest_, ahead, [&](const Stand& stand, double from, double to) {
    if (!(stand.density > 0.0)) return true;
    const double mean = mean_free_path(stand, diameter);
    if (to == ahead.length || left * mean <= to - from) {
      way = from + left * mean;
      return false;
    }
    left -= (to - from) / mean;
    return true;
  });
  return way;
}

bool Stems::go(const PlanWay& gone, double diameter) {
  if (of_list()) return ahead_ && gone.length >= ahead_->way - kReached;
  if (!forest_.by_cell()) {
    left_ -= gone.length / mean_free_path({forest_.density, forest_.diameter}, diameter);
  } else {
    for_each_stand(forest_, gone, [&](const Stand& stand, double from, double to) {
      if (stand.density > 0.0) left_ -= (to - from) / mean_free_path(stand, diameter);
      return true;
    });
  }
  return left_ <= 1e-9;  // a piece that ends at the stem may fall short of it by rounding
}

double Stems::capacity_at(const PlanWay& gone) const {
  if (of_list()) {
    const Tree& tree = forest_.map->trees.at(ahead_->tree);
    return stem_capacity(tree.diameter, forest_.species_factor * tree.species);
  }
  if (!forest_.by_cell() || forest_.map->diameter.values.empty()) return capacity_;
  double diameter = forest_.diameter;  // of the last part of the way that has a forest
  for_each_stand(forest_, gone, [&](const Stand& stand, double, double) {
    if (stand.density > 0.0) diameter = stand.diameter;
    return true;
  });
  return stem_capacity(diameter, forest_.species_factor);
}

Vec3 Stems::hit(const PlanWay& gone, const Vec3& velocity, double mass) {
  const double eccentricity = of_list() ? ahead_->eccentricity : eccentricity_;
  const double capacity = capacity_at(gone) * stem_share(eccentricity) / mass;
  Vec3 after = velocity_after_stem(velocity, std::min(0.5 * velocity.squaredNorm(), capacity), eccentricity);
  of_list() ? touched_.add(ahead_->tree) : draw();
  return after;
}

}  // namespace talus
