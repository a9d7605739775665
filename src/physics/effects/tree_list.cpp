#include "talus/physics/effects/tree_list.hpp"

#include <algorithm>
#include <cmath>

#include "talus/physics/flight.hpp"

namespace talus {
namespace {

constexpr double kTouch = 1e-6;  // distance from the edge of a disc that counts as on it [m]

/// Cells of the index along one direction.
int cells_over(double length, double side) {
  return static_cast<int>(std::floor(length / side)) + 1;
}

double offset_to_the_left(const Eigen::Vector2d& heading, const Eigen::Vector2d& axis) {
  return heading.x() * axis.y() - heading.y() * axis.x();
}

/// Square of the distance from the axis less that of the radius [m^2]: near the edge 2 radius times the gap.
double outside(const Eigen::Vector2d& axis, double radius) {
  return axis.squaredNorm() - radius * radius;
}

}  // namespace

bool TouchedTrees::contains(std::uint32_t tree) const {
  return std::find(trees_.begin(), trees_.end(), tree) != trees_.end();
}

double way_to_disc(const Eigen::Vector2d& axis, const Eigen::Vector2d& heading, double radius) {
  const double ahead = axis.dot(heading), aside = offset_to_the_left(heading, axis);
  if (!(ahead > 0.0) || !(std::abs(aside) < radius)) return kNever;
  if (outside(axis, radius) < -2.0 * radius * kTouch) return kNever;
  return std::max(0.0, ahead - std::sqrt(radius * radius - aside * aside));
}

TreeList::TreeList(const std::vector<Tree>& trees) {
  if (trees.empty()) return;
  Eigen::Vector2d high = trees.front().place;
  corner_ = high;
  for (const Tree& tree : trees) {
    corner_ = corner_.cwiseMin(tree.place), high = high.cwiseMax(tree.place);
    thickest_ = std::max(thickest_, tree.diameter);
  }
  const Eigen::Vector2d size = high - corner_;
  side_ = std::max(2.0, std::sqrt(0.5 * size.x() * size.y() / static_cast<double>(trees.size())));
  columns_ = cells_over(size.x(), side_), rows_ = cells_over(size.y(), side_);

  const auto cell_of = [this](const Tree& tree) {
    return static_cast<std::size_t>(row_of(tree.place.y())) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column_of(tree.place.x()));
  };
  begins_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const Tree& tree : trees) ++begins_[cell_of(tree) + 1];
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  trees_.resize(trees.size());
  for (const Tree& tree : trees) trees_[next[cell_of(tree)]++] = tree;
}

int TreeList::column_of(double x) const {
  return static_cast<int>(std::clamp(std::floor((x - corner_.x()) / side_), 0.0, columns_ - 1.0));
}

int TreeList::row_of(double y) const {
  return static_cast<int>(std::clamp(std::floor((y - corner_.y()) / side_), 0.0, rows_ - 1.0));
}

/// Calls visit(index) for the trees of all cells that a box touches.
template <class Visit>
void TreeList::in_box(const Eigen::Vector2d& low, const Eigen::Vector2d& high, Visit visit) const {
  const int west = column_of(low.x()), east = column_of(high.x());
  for (int row = row_of(low.y()), north = row_of(high.y()); row <= north; ++row) {
    const std::size_t cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
    const std::uint32_t end = begins_[cell + static_cast<std::size_t>(east) + 1];
    for (std::uint32_t tree = begins_[cell + static_cast<std::size_t>(west)]; tree < end; ++tree) visit(tree);
  }
}

std::optional<TreeMeeting> TreeList::first_on(const PlanWay& way, double diameter, const TouchedTrees& touched) const {
  if (trees_.empty() || !way.from.allFinite() || !std::isfinite(way.length)) return std::nullopt;
  const double most = 0.5 * (thickest_ + diameter) + kTouch;
  const Eigen::Vector2d reach(most, most);
  TreeMeeting first{0, kNever, 0.0};
  // The largest index of the trees that were met at this very place, whose edge it is; -1 if there is none. Trees with
  // one edge are met in the order of their indices, each once, however many they are.
  const auto met_here = [&](std::uint32_t index) {
    std::int64_t last = touched.contains(index) ? std::int64_t{index} : -1;
    in_box(way.from - reach, way.from + reach, [&](std::uint32_t other) {
      const double radius = 0.5 * (trees_[other].diameter + diameter);
      if (std::abs(outside(trees_[other].place - way.from, radius)) <= 2.0 * radius * kTouch && touched.contains(other))
        last = std::max(last, std::int64_t{other});
    });
    return last;
  };
  const auto meet = [&](std::uint32_t index) {
    const Tree& tree = trees_[index];
    const Eigen::Vector2d axis = tree.place - way.from;
    const double radius = 0.5 * (tree.diameter + diameter);
    const double to = way_to_disc(axis, way.heading, radius);
    if (!(to <= way.length) || to > first.way || (to == first.way && index > first.tree)) return;
    if (outside(axis, radius) <= 2.0 * radius * kTouch && index <= met_here(index)) return;
    first = {index, to, std::clamp(offset_to_the_left(way.heading, axis) / radius, -1.0, 1.0)};
  };
  // Part by part, so that the box of a long way across the grid stays narrow.
  const double part = std::max(side_, 2.0 * most);
  for (double begin = 0.0; begin <= way.length && begin <= first.way; begin += part) {
    const Eigen::Vector2d a = way.from + begin * way.heading,
                          b = way.from + std::min(begin + part, way.length) * way.heading;
    in_box(a.cwiseMin(b) - reach, a.cwiseMax(b) + reach, meet);
  }
  if (first.way == kNever) return std::nullopt;
  return first;
}

}  // namespace talus
