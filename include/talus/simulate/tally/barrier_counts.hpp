#pragma once
#include <cstdint>
#include <vector>

#include "talus/physics/path.hpp"
#include "talus/simulate/tally/bytes.hpp"

namespace talus {

/// Numbers of meetings of blocks with a part of a barrier.
struct BarrierCounts {
  std::uint64_t over = 0, caught = 0, broken = 0;
  std::uint64_t hits() const { return caught + broken; }
  void add(const BarrierCounts& other) { over += other.over, caught += other.caught, broken += other.broken; }
};

/// Length of the parts of a barrier that are counted separately, from its start [m]; the last may be shorter.
inline constexpr double kBarrierPart = 5.0;

/// The counts of all barriers, by place along each. Integer sums: equal in any order.
class BarrierTally {
 public:
  BarrierTally() = default;
  explicit BarrierTally(const Barriers& barriers);
  void add(const Path& path);
  /// @param other  a tally of the same barriers
  void merge(const BarrierTally& other);
  void save(ByteWriter& out) const;
  /// Throws std::out_of_range if the bytes are of other barriers.
  static BarrierTally restored(const Barriers& barriers, ByteReader& in);

  std::size_t size() const { return parts_.size(); }
  const std::vector<BarrierCounts>& parts(std::size_t barrier) const { return parts_[barrier]; }
  BarrierCounts sum(std::size_t barrier) const;

 private:
  std::vector<std::vector<BarrierCounts>> parts_;  // by barrier
};

}  // namespace talus
