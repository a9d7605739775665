#pragma once
#include <array>
#include <functional>
#include <span>

#include "talus/simulate/tally/barrier_counts.hpp"
#include "talus/simulate/screens/screens.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// Blocks of one source cell that a worker traces in one go, and that are one stratum of the hazard.
inline constexpr std::uint32_t kBlocksPerUnit = 128;

/// The end of one trajectory.
struct StopRow {
  std::uint32_t source, block;
  End end;
  float diameter, mass;                           // of what came to rest: the largest piece where it broke [m], [kg]
  float x_release, y_release;                     // [m, local]
  double x, y, z;                                 // where it ended [m, local]
  float seconds, max_speed, length, plan_length;  // [s], [m/s], [m], [m]
  std::uint32_t impacts;
};

StopRow stop_row(const Release& release, const Path& path);

/// A point of a recorded path, dense enough to draw.
struct PathPoint {
  double x, y, z, time;  // [m, local], [s]
};

/// A path written as a vector.
struct RecordedPath {
  StopRow stop;
  std::vector<PathPoint> points;
};

/// A path as points: its vertices, and points of the parabolas between them at most `spacing` apart in plan [m].
std::vector<PathPoint> points_of(const Path& path, double spacing);

/// What `simulate` hands out while it runs, unit of work by unit, always in the same order (source cells by place, the
/// blocks of each by number) and from one thread at a time.
/// A sink may throw: the run ends and the exception reaches the caller of `simulate`.
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

/// Totals of a run: integers, so that they are equal for any number of threads.
struct Totals {
  std::array<std::uint64_t, kEnds> ends{};  ///< by End
  std::uint64_t released = 0, pieces = 0, impacts = 0, psi_dropped = 0, cells_scored = 0;
  std::int64_t length_mm = 0, plan_length_mm = 0;
  std::array<std::uint32_t, 2> first_limit{};  ///< smallest (source, block) that ended at a limit; see ends
  bool interrupted = false;
  BarrierTally barriers;
  double sink_cpu_seconds = 0.0;  ///< of `cpu_seconds`, spent in the sinks
  double cpu_seconds = 0.0;       ///< of all threads
};

/// Adds what a part of a run has to its whole. The barriers must be the same.
void add(Totals& totals, const Totals& part);

/// Traces every trajectory of the scenario and scores it.
///
/// @param threads  0: as many as the machine has
Totals simulate(const Scenario& scenario, Tally& tally, const Sinks& sinks, int threads);

}  // namespace talus
