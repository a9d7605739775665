#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "talus/simulate/stop_row.hpp"

namespace talus {

/// The energy-line angles of the blocks that stopped or were trapped: counts of steps of 0.01 degrees, equal in any
/// order. Blocks that a barrier caught would have gone on, and those that left are not at their end: they do not count.
/// Beside a release the angle says how rough the ground is there, not how far blocks go: if enough end far away, only
/// those count. docs/products.md, "Energy line".
class EnergyLines {
 public:
  static constexpr double kFar = 100.0;          ///< in plan [m]
  static constexpr std::uint64_t kEnough = 100;  ///< least number of far ends; they must be one in twenty of all, too

  void add(std::span<const StopRow> rows);

  /// Distance in plan beyond which blocks that end count [m]: `kFar`, or 0 (all count) if too few end beyond it.
  double farther_than() const { return far() ? kFar : 0.0; }
  std::uint64_t count() const { return count_[far()]; }
  /// The smallest angle [deg]. Only if there is one.
  double least() const { return percentile(0.0); }
  /// The k-th smallest angle, k = ceil(share n), at least 1, rounded to 0.01 [deg]. Only if there is one.
  double percentile(double share) const;

 private:
  static constexpr int kPerDegree = 100;
  using Counts = std::vector<std::uint64_t>;  // from -90 degrees on

  std::size_t far() const { return count_[1] >= kEnough && 20 * count_[1] >= count_[0] ? 1 : 0; }

  std::array<std::uint64_t, 2> count_{};  // of all, and of those that end far away
  std::array<Counts, 2> counts_{Counts(2 * 90 * kPerDegree + 1), Counts(2 * 90 * kPerDegree + 1)};
};

}  // namespace talus
