#pragma once
#include <cstdint>
#include <mutex>
#include <vector>

#include "talus/simulate/stop_row.hpp"

namespace talus {

/// Mean, percentiles and maximum of values; NaN if there are none.
struct BinDistribution {
  std::uint64_t count = 0;
  double mean = 0.0, p50 = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
};

/// The percentile p is the k-th smallest value, k = ceil(p count). The same bits in any order of the values.
BinDistribution distribution_of(std::vector<float> values);

/// The motion in one bin of a profile. A trajectory counts once in a bin, with its largest value there.
struct ProfileBin {
  double from = 0.0, to = 0.0;            ///< distance from the first node [m]
  BinDistribution speed, energy, height;  ///< [m/s], translational [kJ], vertical above the ground [m]
};

/// Collects trajectories on an extruded profile by bins of x, from several threads.
///
/// Keeps every value: 12 bytes per trajectory and bin that it crosses.
class ProfileBins {
 public:
  /// @param columns  number of columns of the grid between the first and the last node, each `step` [m] wide
  /// @param width    [m], a whole multiple of `step`; the last bin may reach beyond the profile
  ProfileBins(int columns, double step, double width);

  /// Adds a trajectory: exact largest speed and clearance in each bin. `mass` of the block [kg].
  void add(const Path& path, double mass);

  std::vector<ProfileBin> bins() const;

 private:
  struct Values {
    std::vector<float> speed, energy, height;
  };
  double width_;
  int columns_per_bin_;
  std::mutex mutex_;
  std::vector<Values> values_;
};

/// Runout of the blocks: distance in x between release and stop.
struct Runout {
  BinDistribution stopped;           ///< of the blocks that stayed: stopped, trapped or caught [m]
  std::vector<std::uint64_t> stops;  ///< number of these by bin of the distance, from 0
  std::uint64_t released = 0;
};

class RunoutCounter {
 public:
  explicit RunoutCounter(double width) : width_(width) {}
  void add(std::span<const StopRow> rows);
  Runout result() const;

 private:
  double width_;
  std::vector<float> distances_;
  Runout counts_;
};

}  // namespace talus
