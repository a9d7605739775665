#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "commands.hpp"
#include "talus/base/printable.hpp"

Progress::Mode Progress::mode_of(bool quiet, const std::string& progress) {
  if (progress == "machine") return Mode::Machine;
  if (progress == "json") return Mode::Json;
  if (quiet) return Mode::Silent;
  return isatty(STDERR_FILENO) != 0 ? Mode::Terminal : Mode::Lines;
}

Progress::Progress(Mode mode, std::uint64_t trajectories, std::string phase)
    : mode_(mode), trajectories_(static_cast<double>(trajectories)), phase_(std::move(phase)) {
  if (mode_ == Mode::Machine) percent(0);
  if (mode_ == Mode::Json) json(0.0);
}

Progress::~Progress() {
  erase();
}

bool Progress::update(double share) {
  if (mode_ == Mode::Silent) return true;
  if (mode_ == Mode::Machine) return percent(std::clamp(static_cast<int>(99.0 * share), 0, 99));
  const Clock::time_point now = Clock::now();
  if (mode_ == Mode::Json) return json(std::clamp(share, 0.0, 1.0));
  const double interval = mode_ == Mode::Terminal ? 0.2 : 10.0;
  if (std::chrono::duration<double>(now - shown_).count() < interval || !(share > 0.0)) return true;
  shown_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const auto rate = static_cast<std::uint64_t>(share * trajectories_ / elapsed);
  show(part_ + std::to_string(static_cast<int>(100.0 * share)) + " %, " +
       (trajectories_ > 0.0 ? count_text(rate) + " trajectories/s, " : "") +
       duration_text(elapsed * (1.0 - share) / share) + " left");
  return true;
}

void Progress::begin(const std::string& part) {
  part_ = part + ": ";
  start_ = Clock::now();
  if (mode_ == Mode::Terminal) shown_ = start_;
  json_ = -1.0;
}

void Progress::stage(const std::string& text) {
  if (mode_ == Mode::Json) {
    phase_ = "write";
    json_ = -1.0;
    json(0.0);
  }
  const bool long_run = Clock::now() - start_ > std::chrono::seconds(10);
  if (mode_ == Mode::Terminal || (mode_ == Mode::Lines && long_run)) show(text);
}

void Progress::finish() {
  erase();
  if (mode_ == Mode::Machine) percent(100);
  if (mode_ == Mode::Json) json(1.0);
}

void Progress::show(const std::string& text) {
  if (mode_ == Mode::Terminal) {
    std::fprintf(stderr, "\r\033[K%s", talus::printable(text).c_str());
    on_line_ = true;
  } else {
    say("", text);
  }
  std::fflush(stderr);
}

void Progress::erase() {
  if (on_line_) std::fputs("\r\033[K", stderr);
  on_line_ = false;
}

bool Progress::percent(int value) {
  if (value <= percent_) return true;
  percent_ = value;
  return std::fprintf(stderr, "progress %d\n", value) > 0 && std::fflush(stderr) == 0;
}

/// A line for each whole percent of the phase, and for its end.
bool Progress::json(double share) {
  const double shown = share < 1.0 ? std::floor(100.0 * share) / 100.0 : 1.0;
  if (shown <= json_) return true;
  json_ = shown;
  const std::string part = part_.empty() ? "" : ", \"part\": \"" + part_.substr(0, part_.find(':')) + "\"";
  return std::fprintf(stderr, "{\"phase\": \"%s\", \"share\": %.2f%s}\n", phase_.c_str(), shown, part.c_str()) > 0 &&
         std::fflush(stderr) == 0;
}

std::string duration_text(double seconds) {
  const auto total = static_cast<std::uint64_t>(std::ceil(std::clamp(seconds, 0.0, 1e9)));
  const std::uint64_t h = total / 3600, min = total / 60 % 60, s = total % 60;
  if (h > 0) return std::to_string(h) + " h " + std::to_string(min) + " min";
  if (min > 0) return std::to_string(min) + " min " + std::to_string(s) + " s";
  return std::to_string(s) + " s";
}
