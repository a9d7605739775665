#pragma once
#include <bitset>
#include <mutex>
#include <unordered_map>

#include "talus/base/scratch.hpp"
#include "talus/simulate/plan/region.hpp"
#include "talus/simulate/tally/bytes.hpp"

namespace talus {

/// The cells that the trajectories of one source cell have reached so far, by region. Needed only if several batches
/// share a source cell. The lock of a region in the tally also guards its cells here.
class SourceReach {
 public:
  using Cells = std::bitset<kRegionCells>;

  explicit SourceReach(MemoryPolicy memory = {}) : regions_(Allocator(memory)) {}

  Cells& cells(std::size_t region) {
    const std::lock_guard guard(mutex_);
    return regions_[region];  // the reference stays valid when regions are added
  }

  void save(ByteWriter& out) const;
  void restore(ByteReader& in);

 private:
  using Allocator = ScratchAllocator<std::pair<const std::size_t, Cells>>;
  std::mutex mutex_;
  std::unordered_map<std::size_t, Cells, std::hash<std::size_t>, std::equal_to<>, Allocator> regions_;
};

}  // namespace talus
