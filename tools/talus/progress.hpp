#pragma once
#include <chrono>
#include <cstdint>
#include <string>

#include "talus/run/summary.hpp"

/// Shows on stderr how far a run is: one rewritten line on a terminal, else a line every ten seconds; or, for programs,
/// `progress 42` with every whole percent or {"phase": "simulate", "share": 0.42} as JSON.
class Progress {
 public:
  enum class Mode { Silent, Terminal, Lines, Machine, Json };

  /// The mode of the options; without any, the one that suits stderr.
  /// @param progress  what --progress was given: machine, json or nothing
  static Mode mode_of(bool quiet, const std::string& progress);

  /// @param trajectories  number in the whole run; 0: not known, no rate is shown
  /// @param phase         name of what is shown, for JSON
  Progress(Mode mode, std::uint64_t trajectories, std::string phase = "simulate");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param share  of the work that is done, 0..1
  /// @return false if nobody reads the requested output any more (a closed pipe)
  bool update(double share);

  /// A part of the run begins, "round 3". From now on shares and rates are those of this part.
  void begin(const std::string& part);

  /// A stage after the trajectories begins: "writing the results".
  void stage(const std::string& text);

  /// The whole run is done.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& text);
  void erase();
  bool percent(int value);
  bool json(double share);

  Mode mode_;
  double trajectories_;
  Clock::time_point start_ = Clock::now(), shown_ = start_;
  std::string phase_;   // for JSON
  std::string part_;    // text in front of the line
  double json_ = -1.0;  // the share of the last line of JSON
  int percent_ = -1;
  bool on_line_ = false;  // something stands on the current line of the terminal
};

/// "1 h 20 min", "3 min 10 s", "12 s".
std::string duration_text(double seconds);
using talus::run::count_text;
