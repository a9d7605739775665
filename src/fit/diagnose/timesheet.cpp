#include "talus/fit/diagnose/timesheet.hpp"

#include <algorithm>

namespace talus {

Timesheet::Phase::Phase(Timesheet& sheet, std::string phase, std::string effect)
    : sheet_(sheet), time_{std::move(phase), std::move(effect), 0.0}, start_(std::clock()) {
  if (sheet_.open_++ == 0) sheet_.add(time_);  // its place in the order
}

Timesheet::Phase::~Phase() {
  if (--sheet_.open_ > 0) return;
  time_.cpu = static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
  sheet_.add(time_);
}

void Timesheet::add(const PhaseTime& time) {
  const auto same = std::ranges::find_if(
      phases_, [&](const PhaseTime& known) { return known.phase == time.phase && known.effect == time.effect; });
  if (same == phases_.end())
    phases_.push_back(time);
  else
    same->cpu += time.cpu;
}

void Timesheet::add(const Timesheet& other) {
  for (const PhaseTime& time : other.phases_) add(time);
}

}  // namespace talus
