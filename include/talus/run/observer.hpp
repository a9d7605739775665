#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>

namespace talus::run {

/// The user has ended the program (Ctrl-C, SIGTERM).
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws `Interrupted` with a message that nothing was written.
[[noreturn]] void stop_interrupted();

/// Link between a session and its user: receives progress and messages, and says whether the user has ended the
/// program. This base class shows nothing and never ends the program. Each process of a group has its own observer.
class Observer {
 public:
  virtual ~Observer() = default;

  virtual bool interrupted() const { return false; }

  /// The inputs are read; from now on files are written.
  virtual void inputs_read() {}
  /// The work begins.
  /// @param trajectories  number in the whole run; 0: not known
  virtual void begin(std::uint64_t /*trajectories*/) {}
  /// A part of the work begins, "round 3". From now on `progress` gets the share of this part.
  virtual void begin_part(const std::string& /*part*/) {}
  /// @param share  of the work that is done, 0..1
  /// @return false if nobody needs the results any more
  /// Called from any thread, one at a time.
  virtual bool progress(double /*share*/) { return true; }
  /// A stage after the trajectories begins: "writing the results".
  virtual void stage(const std::string& /*text*/) {}
  /// All work is done.
  virtual void finish() {}

  virtual void message(const std::string& /*text*/) {}
  virtual void warning(const std::string& /*text*/) {}
  virtual void error(const std::string& /*text*/) {}
};

}  // namespace talus::run
