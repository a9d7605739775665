#pragma once
#include <optional>

#include "slope.hpp"

namespace talus {

/// The friction of a slide: tan(phi) of the ground, with rolling resistance where it acts. Each cell has its own; those
/// of the four cells that meet in the middle of a patch are kept until the slide leaves the patch.
class SlidingFriction {
 public:
  /// @param resistance  null: none
  SlidingFriction(const Cover& cover, const RollingResistance* resistance) : cover_(cover), resistance_(resistance) {}

  /// Sets the friction of the cell under the block, and whether the slide must stop at the border of this cell.
  void set(Slope& slope, const Motion& motion) {
    if (!of_patch_ || *of_patch_ != slope.at) read_cells(slope);
    slope.tan_phi = tan_phi_[0][0];
    slope.bounded_to.reset();
    if (!differ_) return;
    const Quarter under = quarter_of(slope, motion);
    slope.tan_phi = tan_phi_[under.east][under.north];
    slope.bounded_to = under;
  }

 private:
  void read_cells(const Slope& slope) {
    of_patch_ = slope.at;
    differ_ = false;
    for (const bool east : {false, true})
      for (const bool north : {false, true}) {
        tan_phi_[east][north] = of_cell(slope, {east, north});
        differ_ = differ_ || tan_phi_[east][north] != tan_phi_[0][0];
      }
  }

  /// The quarter of a patch that holds the block. On the border of two cells: the one that the block moves into; for a
  /// block that does not move across the border, the one down the slope.
  static Quarter quarter_of(const Slope& slope, const Motion& motion) {
    const Eigen::Vector2d place = motion.position.head<2>(), downhill = -slope.gradient(place);
    const auto ahead = [&](int axis) { return motion.velocity[axis] != 0.0 ? motion.velocity[axis] : downhill[axis]; };
    return {in_far_half(slope.p_of(place), ahead(0)), in_far_half(slope.q_of(place), ahead(1))};
  }

  double of_cell(const Slope& slope, Quarter quarter) const {
    const Grid& grid = slope.surface.grid();
    const double x = grid.centre_x(slope.at.column + (quarter.east ? 1 : 0)),
                 y = grid.centre_y(slope.at.row + (quarter.north ? 1 : 0));
    const std::uint8_t zone = cover_.zone_at(x, y);
    const bool resists = resistance_ != nullptr && resistance_->where.covers(zone, x, y);
    return cover_.grounds[zone].tan_phi + (resists ? resistance_->coefficient : 0.0);
  }

  const Cover& cover_;
  const RollingResistance* resistance_;
  std::optional<PatchIndex> of_patch_{};
  double tan_phi_[2][2]{};  ///< of the cells: west or east, south or north
  bool differ_ = false;
};

}  // namespace talus
