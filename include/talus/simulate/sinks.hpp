#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "talus/simulate/screens/screens.hpp"
#include "talus/simulate/stop_row.hpp"

namespace talus {

/// Receivers of the rows of a run. Rows arrive during the run, unit of work by unit of work, always in the same order
/// (source cells by place, the blocks of each by number), from one thread at a time. A sink may throw: the run ends and
/// the exception reaches the caller of `simulate`.
struct Sinks {
  std::function<void(std::uint64_t)> unit;  ///< the rows that follow are of this unit
  std::function<void(std::span<const StopRow>)> stops;
  std::function<void(std::span<const Crossing>)> crossings;
  std::function<void(const RecordedPath&)> paths;
  double path_spacing = 0.0;  ///< largest distance between points of `paths` [m]; 0: one cell
  /// Receives every path. Unlike the others, in any order and from several threads at a time.
  std::function<void(const Release&, const Path&)> walked;
  /// Called with the share done, 0..1, after every unit of work; false interrupts the run. From any thread, one at a
  /// time.
  std::function<bool(double)> progress;
  /// Called after every unit of work, as `progress`; true pauses the run, so that it can be saved.
  std::function<bool()> pause;
};

}  // namespace talus
