#pragma once
#include <algorithm>
#include <cstdint>
#include <mutex>
#include <optional>

#include "talus/simulate/plan/process_group.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// Number of blocks in a unit of work: blocks of one source cell, traced by one worker; one stratum of the hazard.
inline constexpr std::uint32_t kBlocksPerUnit = 128;

/// Number of units of a source cell; the last one has the rest of its blocks.
inline std::uint32_t units_per_source(const Scenario& scenario) {
  return (scenario.trajectories + kBlocksPerUnit - 1) / kBlocksPerUnit;
}

/// The blocks of a unit within a round: from `first`, before `end`.
struct UnitBlocks {
  std::uint32_t first, end;
};

/// @param unit  its number among the units of its source cell
inline UnitBlocks blocks_of_unit(const Scenario& scenario, std::uint32_t unit) {
  const std::uint32_t first = unit * kBlocksPerUnit;
  return {first, std::min(scenario.trajectories, first + kBlocksPerUnit)};
}

/// A unit as a stratum: its number among the units of the scenario, source cell by source cell, and its blocks.
struct Stratum {
  std::uint64_t number;
  std::uint32_t blocks;
};

/// The stratum of a block of a source cell.
inline Stratum stratum_of(const Scenario& scenario, std::uint32_t source, std::uint32_t block) {
  const std::uint32_t unit = block / kBlocksPerUnit;
  const UnitBlocks blocks = blocks_of_unit(scenario, unit);
  return {std::uint64_t{source} * units_per_source(scenario) + unit, blocks.end - blocks.first};
}

/// Hands out the units of work of a round, each once, to all threads of all processes that trace it.
///
/// A chunk is a number of consecutive units. Either a free process takes the next chunk; or each chunk belongs to one
/// process, the same in every round, and the cells that its source cells have reached stay with that process.
class WorkUnits {
 public:
  struct Range {
    std::uint64_t first, end;
  };
  /// A unit, and its index among the units taken by this process.
  struct Taken {
    std::uint64_t unit, number;
  };

  /// All processes must construct it.
  ///
  /// @param range  the units to trace
  /// @param chunk  chunks begin at multiples of this
  /// @param fixed  each chunk belongs to one process
  WorkUnits(ProcessGroup& processes, const Range& range, std::uint64_t chunk, bool fixed);

  /// The next unit; nothing if none is left, or after `stop`. From any thread.
  std::optional<Taken> next();

  /// Lets all processes complete the chunks that they have begun, and take no more. From any thread.
  void stop();

  /// All processes must call it, each when it has done all units that it took. True: all units before `end` are done,
  /// by whichever process. False: call `next` again until it returns nothing, then this again.
  bool agree_on_end();
  std::uint64_t end() const { return end_; }

  /// Whether a chunk, by the unit it begins with, belongs to this process.
  static bool owns(const ProcessGroup& processes, std::uint64_t unit, std::uint64_t chunk) {
    return unit / chunk % static_cast<std::uint64_t>(processes.size()) == static_cast<std::uint64_t>(processes.rank());
  }

 private:
  std::uint64_t next_chunk();

  ProcessGroup& processes_;
  Range range_;
  std::uint64_t chunk_, chunks_;  // units of a chunk; the first chunk that is not wanted
  bool fixed_;
  std::mutex mutex_;                 // guards the members below
  std::uint64_t at_ = 0, till_ = 0;  // units of the current chunk
  std::uint64_t taken_ = 0;
  std::uint64_t mine_ = 0;   // next chunk of this process, if chunks are fixed
  std::uint64_t closed_at_;  // all chunks before this one were taken
  bool catching_up_ = false;
  std::uint64_t end_ = 0;
};

}  // namespace talus
