#pragma once
#include <cstdint>
#include <mutex>
#include <optional>

#include "talus/simulate/plan/process_group.hpp"

namespace talus {

/// Blocks of one source cell that a worker traces in one go, and that are one stratum of the hazard.
inline constexpr std::uint32_t kBlocksPerUnit = 128;

/// Hands out the units of work of a round, each once, to all threads of all processes that trace it.
///
/// Processes take chunks of units that follow each other: whoever is free the next one. Or each chunk belongs to one
/// process, the same in every round, so that what this knows of its source cells stays with it.
class WorkUnits {
 public:
  struct Range {
    std::uint64_t first, end;
  };
  /// A unit, and its index among the units taken by this process.
  struct Taken {
    std::uint64_t unit, number;
  };

  /// All processes must make it.
  ///
  /// @param range  of the units that are to be traced
  /// @param chunk  chunks begin at multiples of this
  /// @param fixed  each chunk belongs to one process
  WorkUnits(ProcessGroup& processes, const Range& range, std::uint64_t chunk, bool fixed);

  /// Nothing where none is left or asked for. From any thread.
  std::optional<Taken> next();

  /// Nothing further is to be taken, by no process, than chunks that are begun. From any thread.
  void stop();

  /// All that this process has taken is done. Once it has returned true all before `end` is done, by whichever process;
  /// until then go on taking. All processes must call it.
  bool finish();
  std::uint64_t end() const { return end_; }

  /// Whether a chunk, by the unit it begins with, belongs to this process.
  static bool owns(const ProcessGroup& processes, std::uint64_t unit, std::uint64_t chunk) {
    return unit / chunk % static_cast<std::uint64_t>(processes.size()) == static_cast<std::uint64_t>(processes.rank());
  }

 private:
  std::uint64_t next_chunk();

  ProcessGroup& processes_;
  Range range_;
  std::uint64_t chunk_, chunks_;  // units of one; first one that is not wanted
  bool fixed_;
  std::mutex mutex_;                 // guards what follows
  std::uint64_t at_ = 0, till_ = 0;  // units of the chunk in work
  std::uint64_t taken_ = 0;
  std::uint64_t mine_ = 0;   // next chunk of this process, where they are fixed
  std::uint64_t closed_at_;  // chunk before which all were taken
  bool catching_up_ = false;
  std::uint64_t end_ = 0;
};

}  // namespace talus
