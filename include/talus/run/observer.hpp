#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>

namespace talus::run {

/// The user has ended the program (Ctrl-C, SIGTERM).
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws `Interrupted`: nothing was written.
[[noreturn]] void stop_interrupted();

/// The outside world of a session: it is told how far the work is and what the user should know, and asked whether the
/// user has ended the program. This one says nothing and never ends it. Of several processes each has its own.
class Observer {
 public:
  virtual ~Observer() = default;

  virtual bool interrupted() const { return false; }

  /// The work begins.
  /// @param trajectories  of the whole run; 0: not known
  virtual void begin(std::uint64_t /*trajectories*/) {}
  /// A part of the work begins, "round 3": shares are from now on its own.
  virtual void begin_part(const std::string& /*part*/) {}
  /// @param share  done, 0..1. Returns false where nobody needs the results any more. From any thread, one at a time
  virtual bool progress(double /*share*/) { return true; }
  /// What follows the trajectories: "writing the results".
  virtual void stage(const std::string& /*text*/) {}
  /// All work is done.
  virtual void finish() {}

  virtual void message(const std::string& /*text*/) {}
  virtual void warning(const std::string& /*text*/) {}
  virtual void error(const std::string& /*text*/) {}
};

}  // namespace talus::run
