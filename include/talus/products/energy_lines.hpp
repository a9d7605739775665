#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "talus/simulate/stop_row.hpp"

namespace talus {

/// The energy-line angles of the blocks that stopped or were trapped: counts of steps of 0.01 degrees, equal in any
/// order. Blocks that a barrier caught would have gone on, and those that left are not at their end: they do not count.
/// docs/products.md, "Energy line".
class EnergyLines {
 public:
  void add(std::span<const StopRow> rows);

  std::uint64_t count() const { return count_; }
  /// The smallest angle [deg]. Only if there is one.
  double least() const { return percentile(0.0); }
  /// The k-th smallest angle, k = ceil(share n), at least 1, rounded to 0.01 [deg]. Only if there is one.
  double percentile(double share) const;

 private:
  static constexpr int kPerDegree = 100;

  std::uint64_t count_ = 0;
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(2 * 90 * kPerDegree + 1);  // from -90 degrees on
};

}  // namespace talus
