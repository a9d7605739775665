#pragma once
#include <optional>

#include "commands.hpp"
#include "progress.hpp"
#include "talus/run/run_session.hpp"

/// Prints the progress and messages of a session on stderr. A signal of the user ends the session.
class TerminalObserver : public talus::run::Observer {
 public:
  /// @param quiet  prints errors only
  TerminalObserver(Progress::Mode mode, bool quiet) : mode_(mode), quiet_(quiet) {}

  bool interrupted() const override;
  void inputs_read() override { catch_signals(); }
  void begin(std::uint64_t trajectories) override { progress_.emplace(mode_, trajectories); }
  void begin_part(const std::string& part) override { progress_->begin(part); }
  bool progress(double share) override { return progress_->update(share); }
  void stage(const std::string& text) override { progress_->stage(text); }
  void finish() override { progress_->finish(); }
  void message(const std::string& text) override;
  void warning(const std::string& text) override;
  void error(const std::string& text) override;

 private:
  Progress::Mode mode_;
  bool quiet_;
  std::optional<Progress> progress_;
};

/// The exit code for the outcome of a session.
int exit_code(talus::run::Outcome outcome);
