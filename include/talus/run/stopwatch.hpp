#pragma once

namespace talus::run {

/// Measures the stages of a run.
class Stopwatch {
 public:
  struct Lap {
    double cpu, wall;  // [s]
  };
  /// Seconds since the last call.
  Lap lap();

 private:
  static Lap read();
  Lap last_ = read();
};

}  // namespace talus::run
