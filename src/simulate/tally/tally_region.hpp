#pragma once
#include <deque>
#include <mutex>

#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// The records of 64 x 64 cells. `slot` of a cell is the number of its record plus one; 0 if it has no record yet.
struct Tally::Region {
  explicit Region(MemoryPolicy policy)
      : memory(policy),
        slot(policy),
        records(policy),
        exceedances(policy),
        lengths(policy),
        totals(policy),
        hazards(policy) {}

  MemoryPolicy memory;
  std::mutex mutex;
  ScratchVector<std::uint16_t> slot;  // empty: no cell was touched
  std::deque<CellRecord, ScratchAllocator<CellRecord>> records;
  ScratchVector<std::uint32_t> exceedances;
  ScratchVector<std::int64_t> lengths;                            // above each energy threshold, by record
  std::deque<EnergyTotal, ScratchAllocator<EnergyTotal>> totals;  // by record, if the energy with rotation is kept
  std::deque<HazardCell, ScratchAllocator<HazardCell>> hazards;   // by record, if hazard is counted

  /// Number of the record of a cell; makes the record if there is none.
  std::size_t record_of(std::size_t cell, std::size_t thresholds, std::size_t energies) {
    if (slot.empty()) slot.resize(kRegionCells);
    std::uint16_t& number = slot[cell];
    if (number == 0) {
      records.emplace_back(memory);
      extend(exceedances, thresholds);
      extend(lengths, energies);
      number = static_cast<std::uint16_t>(records.size());
    }
    return number - 1U;
  }

  /// Appends zeros. Grows in small steps: doubling would reserve too much.
  template <class Numbers>
  static void extend(Numbers& numbers, std::size_t count) {
    if (numbers.size() == numbers.capacity()) numbers.reserve(numbers.size() + 128 * count);
    numbers.resize(numbers.size() + count);
  }

  /// Makes an energy with rotation for each record that has none.
  void make_totals() {
    while (totals.size() < records.size()) totals.emplace_back(memory);
  }

  /// Makes a hazard cell for each record that has none.
  void make_hazards() {
    while (hazards.size() < records.size()) hazards.emplace_back(memory);
  }
};

}  // namespace talus
