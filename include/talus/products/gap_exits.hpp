#pragma once
#include <cstdint>
#include <span>
#include <unordered_map>

#include "talus/simulate/stop_row.hpp"
#include "talus/terrain/raster.hpp"

namespace talus {

/// Counts the blocks that leave the terrain into gaps of the DEM, not at its edge: from cells `DemGaps::beside` gaps.
/// The counts do not depend on the order of the rows.
class GapExits {
 public:
  /// @param heights  of the terrain; it must outlive this
  explicit GapExits(const Raster<float>& heights) : heights_(heights) {}

  void add(std::span<const StopRow> rows);
  /// Searches the gaps: call it once, after the last row.
  std::uint64_t blocks() const;

 private:
  const Raster<float>& heights_;
  std::unordered_map<std::size_t, std::uint64_t> by_cell_;  // only cells from which some block leaves the terrain
};

}  // namespace talus
