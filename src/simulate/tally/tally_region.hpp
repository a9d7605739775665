#pragma once
#include <deque>
#include <mutex>

#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// The records of 64 x 64 cells. `slot` of a cell is the number of its record plus one; 0 if it has no record yet.
struct Tally::Region {
  explicit Region(MemoryPolicy policy)
      : memory(policy), slot(policy), records(policy), exceedances(policy), hazards(policy) {}

  MemoryPolicy memory;
  std::mutex mutex;
  ScratchVector<std::uint16_t> slot;  // empty: no cell was touched
  std::deque<CellRecord, ScratchAllocator<CellRecord>> records;
  ScratchVector<std::uint32_t> exceedances;
  std::deque<HazardCell, ScratchAllocator<HazardCell>> hazards;  // by record, if hazard is counted

  /// Number of the record of a cell; makes the record if there is none.
  std::size_t record_of(std::size_t cell, std::size_t thresholds) {
    if (slot.empty()) slot.resize(kRegionCells);
    std::uint16_t& number = slot[cell];
    if (number == 0) {
      records.emplace_back(memory);
      if (exceedances.size() == exceedances.capacity())  // small steps: doubling would reserve too much
        exceedances.reserve(exceedances.size() + 128 * thresholds);
      exceedances.resize(exceedances.size() + thresholds);
      number = static_cast<std::uint16_t>(records.size());
    }
    return number - 1U;
  }

  /// Makes a hazard cell for each record that has none.
  void make_hazards() {
    while (hazards.size() < records.size()) hazards.emplace_back(memory);
  }
};

}  // namespace talus
