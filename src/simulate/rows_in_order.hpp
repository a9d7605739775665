#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "talus/simulate/sinks.hpp"

namespace talus {

/// The rows of one unit of work (some blocks of one source cell) for the sinks.
struct UnitRows {
  std::uint64_t unit;
  std::vector<StopRow> stops;
  std::vector<Crossing> crossings;
  std::vector<RecordedPath> paths;
};

/// Hands the rows to the sinks in the order in which the units were taken, whichever worker finishes first.
class RowsInOrder {
 public:
  explicit RowsInOrder(const Sinks& sinks) : sinks_(sinks) {}

  void hand_in(std::uint64_t number, UnitRows&& rows) {
    const std::lock_guard guard(mutex_);
    if (handing_out_) return;  // a sink threw: none is called again
    handing_out_ = true;
    waiting_.emplace(number, std::move(rows));
    for (auto it = waiting_.begin(); it != waiting_.end() && it->first == next_; it = waiting_.erase(it), ++next_) {
      if (sinks_.unit) sinks_.unit(it->second.unit);
      if (sinks_.stops) sinks_.stops(it->second.stops);
      if (sinks_.crossings && !it->second.crossings.empty()) sinks_.crossings(it->second.crossings);
      if (sinks_.paths)
        for (const RecordedPath& path : it->second.paths) sinks_.paths(path);
    }
    handing_out_ = false;
  }

 private:
  const Sinks& sinks_;
  std::mutex mutex_;
  std::map<std::uint64_t, UnitRows> waiting_;
  std::uint64_t next_ = 0;
  bool handing_out_ = false;  // stays true after an exception
};

}  // namespace talus
