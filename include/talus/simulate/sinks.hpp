#pragma once
#include <cstdint>
#include <functional>
#include <span>

#include "talus/simulate/screens/screens.hpp"
#include "talus/simulate/stop_row.hpp"

namespace talus {

/// Receivers of the rows of a run while it goes on: unit of work by unit, always in the same order (source cells by
/// place, the blocks of each by number) and from one thread at a time. A sink may throw: the run ends and the exception
/// reaches the caller of `simulate`.
struct Sinks {
  std::function<void(std::uint64_t)> unit;  ///< the rows that follow are of this unit
  std::function<void(std::span<const StopRow>)> stops;
  std::function<void(std::span<const Crossing>)> crossings;
  std::function<void(const RecordedPath&)> paths;
  double path_spacing = 0.0;  ///< of the points of `paths`, at most [m]; 0: a cell
  /// Every path, unlike the others in any order and from several threads at a time.
  std::function<void(const Release&, const Path&)> walked;
  /// Called with the share done, 0..1, after every unit of work; false interrupts the run. From any thread, one at a
  /// time.
  std::function<bool(double)> progress;
  /// Asked after every unit of work whether to pause, so that what is done can be kept; as `progress`.
  std::function<bool()> pause;
};

}  // namespace talus
