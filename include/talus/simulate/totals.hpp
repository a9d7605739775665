#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "talus/physics/path.hpp"
#include "talus/simulate/tally/barrier_counts.hpp"

namespace talus {

/// Totals of a run. All but the times are integers, so that they are equal for any number of threads.
struct Totals {
  std::array<std::uint64_t, kEnds> ends{};  ///< by End
  std::uint64_t released = 0, pieces = 0, impacts = 0, psi_dropped = 0, cells_scored = 0;
  std::int64_t length_mm = 0, plan_length_mm = 0;
  std::uint64_t left_blocks = 0;               ///< that left the terrain, or of which a piece did
  std::uint64_t limited_blocks = 0;            ///< that ended at a limit, or of which a piece did
  std::int64_t left_weight = 0;                ///< their annual frequency, in units of WeightScale::unit
  std::array<std::uint32_t, 2> first_limit{};  ///< smallest (source, block) of them
  bool interrupted = false;
  BarrierTally barriers;
  double sink_cpu_seconds = 0.0;  ///< the part of `cpu_seconds` spent in the sinks
  double cpu_seconds = 0.0;       ///< of all threads

  std::uint64_t ended(End end) const { return ends[static_cast<std::size_t>(end)]; }
};

/// Adds the totals of a part of a run. The barriers must be the same.
void add(Totals& totals, const Totals& part);

}  // namespace talus
