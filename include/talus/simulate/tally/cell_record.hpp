#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "talus/simulate/scenario/frequency.hpp"
#include "talus/simulate/tally/histogram.hpp"
#include "talus/simulate/tally/quantities.hpp"

namespace talus {

/// The values of the trajectories that cross a cell: one per trajectory and quantity. A buffer that keeps its memory.
struct CellValues {
  PerQuantity<std::vector<float>> lists;
  std::vector<AnnualShare> annual_shares;  ///< of each trajectory, if `keep_annual_shares`
  std::vector<float> totals;               ///< energy with rotation of each trajectory [kJ], if `keep_totals`
  bool keep_annual_shares = false, keep_totals = false;
  std::size_t count = 0;

  void make_room(std::size_t n);
  std::span<const float> of(Quantity quantity) const { return {lists[quantity].data(), count}; }
};

/// The energy with rotation of the trajectories that cross a cell. Kept on request, beside the record of the cell.
struct EnergyTotal {
  float maximum = 0.0F;  ///< [kJ]
  std::int64_t sum = 0;  ///< fixed point, in units of the energy of the table of quantities
  LogHistogram histogram;

  EnergyTotal() = default;
  explicit EnergyTotal(MemoryPolicy memory) : histogram(memory) {}
  double mean() const;
  /// Adds trajectories. Returns the largest value among them.
  float add(std::span<const float> values);
  void merge(const EnergyTotal& other);
  void save(ByteWriter& out) const;
  static EnergyTotal restored(ByteReader& in);
};

/// The sums of one cell. Only integer sums, maxima and histograms: equal bits in any order of the trajectories.
struct CellRecord {
  static constexpr double kLengthUnit = 0x1p-20;  ///< of the sums of lengths [m], and of their squares [m^2]

  std::uint64_t impacts = 0;
  std::int64_t length = 0;          ///< in plan, of all passages together
  std::int64_t length_squares = 0;  ///< sum over the blocks of the square of each one's length
  std::uint32_t passages = 0, sources = 0;
  std::uint32_t deposits = 0;  ///< blocks that stay here
  std::uint32_t trapped = 0;   ///< those of them that are trapped
  std::uint32_t exits = 0;     ///< paths that leave the terrain from here
  PerQuantity<float> maximum{};
  PerQuantity<std::int64_t> sum{};  ///< fixed point, in units of the table
  PerQuantity<LogHistogram> histogram;

  CellRecord() = default;
  explicit CellRecord(MemoryPolicy memory) {
    for (LogHistogram& h : histogram) h = LogHistogram(memory);
  }
  double mean(Quantity quantity) const;
  /// Adds trajectories. Returns the largest value of each quantity among them.
  PerQuantity<float> add(const CellValues& values);
  void merge(const CellRecord& other);
  void save(ByteWriter& out) const;
  static CellRecord restored(ByteReader& in);
};

}  // namespace talus
