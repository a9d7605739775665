#pragma once
#include <deque>
#include <mutex>

#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// The records of 64 x 64 cells. `slot` of a cell is its record's number plus one; 0 where there is none yet.
struct Tally::Region {
  explicit Region(MemoryPolicy policy)
      : memory(policy), slot(policy), records(policy), exceedances(policy), hazards(policy) {}

  MemoryPolicy memory;
  std::mutex mutex;
  ScratchVector<std::uint16_t> slot;  // empty: no cell was touched
  std::deque<CellRecord, ScratchAllocator<CellRecord>> records;
  ScratchVector<std::uint32_t> exceedances;
  std::deque<HazardCell, ScratchAllocator<HazardCell>> hazards;  // by record, where hazard is kept

  /// Number of the record of a cell, made where there is none.
  std::size_t record_of(std::size_t cell, std::size_t thresholds) {
    if (slot.empty()) slot.resize(kRegionCells);
    std::uint16_t& number = slot[cell];
    if (number == 0) {
      records.emplace_back(memory);
      if (exceedances.size() == exceedances.capacity())  // in small steps: doubling would waste what it holds ready
        exceedances.reserve(exceedances.size() + 128 * thresholds);
      exceedances.resize(exceedances.size() + thresholds);
      number = static_cast<std::uint16_t>(records.size());
    }
    return number - 1U;
  }

  /// Gives each record its hazard.
  void make_hazards() {
    while (hazards.size() < records.size()) hazards.emplace_back(memory);
  }
};

}  // namespace talus
