#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "talus/physics/line_piece.hpp"

namespace talus {

/// What is closer to a barrier than this stands on its line [m]: above what rounding does to places in millions of
/// metres.
inline constexpr double kOneLine = 1e-6;

/// A net or a wall: catches a block that crosses its line below the top and within its capacity. docs/barrier.md,
/// "Barriers in the walk".
struct Barrier {
  std::string id;
  std::vector<std::vector<Eigen::Vector2d>> lines;  ///< in plan [m, local]; more than one if it has parts
  double height = 0.0;                              ///< of the top above the ground at the line [m]; 0: off
  double capacity = 0.0;                            ///< largest translational energy it can stop [J]; may be infinite
};

/// Result of crossing the line of a barrier.
enum class Meeting : std::uint8_t {
  Over,    ///< the block's lowest point at the top or above
  Caught,  ///< below the top, within the capacity
  Broken   ///< below the top, above the capacity: it goes on with the rest of its energy
};

/// One meeting of a block and a barrier.
struct BarrierPassage {
  std::uint32_t barrier;
  Meeting how;
  double along;  ///< distance along the barrier from its start, over all its lines [m]
};

/// Result for a block that crosses the line of a barrier.
///
/// @param clearance  of the block's lowest point above the ground [m]; NaN counts as below the top
/// @param energy     translational [J]; NaN counts as within the capacity
Meeting meeting(const Barrier& barrier, double clearance, double energy);

/// Share of the speed that a block has left after it broke a barrier: sqrt((E - C) / E), in [0, 1].
///
/// @param energy    E [J], > capacity
/// @param capacity  C [J], >= 0
double kept_speed(double energy, double capacity);

/// All barriers, with a bounding box around every few pieces of line, so that a way far from them is sorted out
/// quickly.
class Barriers {
 public:
  explicit Barriers(std::vector<Barrier> barriers = {});

  /// Crossing of a straight way in plan with a barrier.
  struct Cut {
    double share;         ///< of the way before the crossing, 0..1
    std::uint32_t piece;  ///< index of the piece of a line, over all barriers
    std::uint32_t barrier;
    double along;  ///< distance along the barrier [m], as in BarrierPassage
  };
  /// The first crossing of the straight way from `a` to `b` after `last` (in the order of share, then piece); empty if
  /// there is none. See `crossing_of`.
  std::optional<Cut> next(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::optional<Cut>& last) const;

  const std::vector<Barrier>& list() const { return barriers_; }
  bool empty() const { return barriers_.empty(); }
  /// Total length of all lines of a barrier [m].
  double length(std::size_t barrier) const { return lengths_[barrier]; }

 private:
  struct Box {
    Eigen::Vector2d low, high;
    std::uint32_t first, end;  // its pieces: from `first`, before `end`
  };
  std::vector<Barrier> barriers_;
  std::vector<double> lengths_;
  std::vector<LinePiece> pieces_;
  std::vector<Box> boxes_;
};

}  // namespace talus
