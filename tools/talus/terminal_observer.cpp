#include "terminal_observer.hpp"

#include "program.hpp"

bool TerminalObserver::interrupted() const {
  return ::interrupted();
}

void TerminalObserver::message(const std::string& text) {
  if (!quiet_) say("", text);
}

void TerminalObserver::warning(const std::string& text) {
  if (!quiet_) say("warning", text);
}

void TerminalObserver::error(const std::string& text) {
  say("error", text);
}

int exit_code(talus::run::Outcome outcome) {
  return outcome == talus::run::Outcome::Done ? kDone : kFailed;
}
