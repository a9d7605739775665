#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "talus/base/vector.hpp"

namespace talus {

/// A net or a wall: catches what crosses its line low and slowly enough. docs/barrier.md, "Barriers in the walk".
struct Barrier {
  std::string id;
  std::vector<std::vector<Eigen::Vector2d>> lines;  ///< in plan [m, local]; more than one where it has parts
  double height = 0.0;                              ///< of the top above the ground at the line [m]; 0: catches nothing
  double capacity = 0.0;                            ///< translational energy that it takes [J]; may be infinite
};

/// What became of a block where it crossed the line of a barrier.
enum class Meeting : std::uint8_t {
  Over,    ///< its centre passed at the top or above
  Caught,  ///< below the top, within the capacity
  Broken   ///< below the top, above the capacity: it goes on with the energy that is left
};

/// A block met a barrier.
struct BarrierPassage {
  std::uint32_t barrier;
  Meeting how;
  double along;  ///< distance along the barrier from its start, over all its lines [m]
};

/// @param clearance  of the block's centre above the ground [m];  energy: translational [J]
/// NaN is caught.
Meeting meeting(const Barrier& barrier, double clearance, double energy);

/// Share of the speed that is left of a block that broke through: sqrt((E - C) / E), in [0, 1].
///
/// @param energy  E [J], > capacity;  capacity: C [J], >= 0
double kept_speed(double energy, double capacity);

/// All barriers, in boxes of a few segments each so that ways far from them are told at once.
class Barriers {
 public:
  explicit Barriers(std::vector<Barrier> barriers = {});

  /// A way in plan crosses a segment of a barrier.
  struct Cut {
    double share;           ///< of the way
    std::uint32_t segment;  ///< number of it, over all barriers
    std::uint32_t barrier;
    double along;  ///< as BarrierPassage
  };
  /// The first crossing of the straight way from `a` to `b` after `last` (in the order of share, then segment); nothing
  /// where there is none. A segment is crossed where the ends of the way lie on different sides of it; its own ends
  /// belong to one side only, so that a way through a corner of a path or of a barrier crosses once.
  std::optional<Cut> next(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::optional<Cut>& last) const;

  const std::vector<Barrier>& list() const { return barriers_; }
  bool empty() const { return barriers_.empty(); }
  /// Of all lines of a barrier together [m].
  double length(std::size_t barrier) const { return lengths_[barrier]; }

 private:
  struct Segment {
    std::uint32_t barrier;
    Eigen::Vector2d from, to;
    double along;  // of `from` [m]
  };
  struct Box {
    Eigen::Vector2d low, high;
    std::uint32_t first, end;  // segments in it
  };
  std::vector<Barrier> barriers_;
  std::vector<double> lengths_;
  std::vector<Segment> segments_;
  std::vector<Box> boxes_;
};

}  // namespace talus
