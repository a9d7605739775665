#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "talus/simulate/simulate.hpp"
#include "talus/simulate/plan/process_group.hpp"

/// What `run` and `profile` share.

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

/// Throws `Interrupted`.
[[noreturn]] void stop_interrupted();

/// Input that is wrong for a process group: the leader says it for all.
struct WrongForAll : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Does it in every process of a process group. Where it throws InputError in one of them, throws `WrongForAll` in all of them;
/// in a single process what it has thrown.
void together(talus::ProcessGroup& processes, const std::function<void()>& what);

/// --memory, such as "2G" or "500M", in bytes. Throws InputError where it is none, or less than what so many threads
/// need to trace, or to write maps.
std::size_t memory_limit_of(const std::string& text, int threads);

/// The command line with --resume.
std::string command_to_resume();

/// Names of the files in a folder, in the order of the alphabet.
std::vector<std::string> files_in(const std::filesystem::path& folder);

std::uint64_t count_of(const talus::Totals& totals, talus::End end);

/// "3.14 %".
std::string share_text(std::uint64_t part, std::uint64_t whole);

/// "12 stopped, 3 left the map, 0 caught, 0 at a limit".
std::string ends_text(const talus::Totals& totals);

/// "12 of 3 400 trajectories (0.353 %, allowed are 0.1 %) ended at the limit of impacts or time".
std::string limits_text(const talus::Totals& totals);
