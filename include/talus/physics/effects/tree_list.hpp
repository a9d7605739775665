#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "talus/base/vector.hpp"

namespace talus {

/// A straight way in plan.
struct PlanWay {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();     ///< [m, local]
  Eigen::Vector2d heading = Eigen::Vector2d::Zero();  ///< of length 1; 0 if the way has no length
  double length = 0.0;                                ///< [m]
};

/// One tree of a list. It stays: no block fells it.
struct Tree {
  Eigen::Vector2d place;  ///< of its axis [m, local]
  double diameter;        ///< DBH [m]
  double species;         ///< factor of its species on the energy that it takes; 1: silver fir [-]
};

/// Meeting of a way with a stem.
struct TreeMeeting {
  std::uint32_t tree;   ///< index in the list
  double way;           ///< to it [m]
  double eccentricity;  ///< offset of the axis from the way, as a share of (DBH + D)/2; > 0: the axis is on the left
};

/// The trees that a block has met last. It does not meet one of them again before it has left it.
class TouchedTrees {
 public:
  void add(std::uint32_t tree) { trees_[next_++ % trees_.size()] = tree; }
  bool contains(std::uint32_t tree) const;

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::array<std::uint32_t, 8> trees_{kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  std::uint32_t next_ = 0;
};

/// Way to the edge of a disc [m]; infinite if the way does not lead into it, or begins inside.
///
/// @param axis  of the disc, from the beginning of the way [m]
///
/// Closed form. Error: a few eps of the distance. A way that begins within 1e-6 m of the edge counts as on it.
double way_to_disc(const Eigen::Vector2d& axis, const Eigen::Vector2d& heading, double radius);

/// Single trees with an index of their places: square cells, at most about two per tree. Memory: 40 bytes per tree.
class TreeList {
 public:
  TreeList() = default;
  /// @param trees  at most 2^32 - 2, in the order of the file
  explicit TreeList(const std::vector<Tree>& trees);

  bool empty() const { return trees_.empty(); }
  std::size_t size() const { return trees_.size(); }
  /// The trees, ordered by cell of the index.
  const std::vector<Tree>& trees() const { return trees_; }
  const Tree& at(std::uint32_t tree) const { return trees_[tree]; }

  /// The first stem on a way: the first disc of radius (DBH + diameter)/2 that the way enters.
  ///
  /// @param diameter  of the block [m]
  /// Exact but for rounding; of two at the same way the one with the smaller index.
  std::optional<TreeMeeting> first_on(const PlanWay& way, double diameter, const TouchedTrees& touched) const;

 private:
  int column_of(double x) const;  ///< of the index, within its bounds
  int row_of(double y) const;
  template <class Visit>
  void in_box(const Eigen::Vector2d& low, const Eigen::Vector2d& high, Visit visit) const;

  std::vector<Tree> trees_;
  std::vector<std::uint32_t> begins_;  // of the cells of the index in trees_, and the end
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();
  double side_ = 1.0, thickest_ = 0.0;  // [m]
  int columns_ = 0, rows_ = 0;
};

}  // namespace talus
