#include "diagnosis_times.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr double kWorthALine = 0.05;  // share of the time

/// The phases and, last, what is none of them: the held-out rows, reading and writing.
std::vector<PhaseTime> all_phases(const DiagnosisRecord& record) {
  std::vector<PhaseTime> phases = record.diagnosis.times.phases();
  double rest = record.cpu_seconds;
  for (const PhaseTime& time : phases) rest -= time.cpu;
  phases.push_back({"held-out rows, files", "", std::max(0.0, rest)});
  return phases;
}

}  // namespace

Json times_json(const DiagnosisRecord& record) {
  Json phases = Json::array();
  for (const PhaseTime& time : all_phases(record)) {
    Json row{{"phase", time.phase}, {"cpu", json_of(time.cpu)}};
    if (!time.effect.empty()) row["effect"] = time.effect;
    phases.push_back(row);
  }
  return {{"cpu", json_of(record.cpu_seconds)}, {"vertices", record.diagnosis.vertices}, {"phases", phases}};
}

std::string time_line(const DiagnosisRecord& record) {
  std::vector<PhaseTime> phases = all_phases(record);
  std::erase_if(phases, [&](const PhaseTime& time) { return time.cpu < kWorthALine * record.cpu_seconds; });
  std::ranges::stable_sort(phases, [](const PhaseTime& a, const PhaseTime& b) { return a.cpu > b.cpu; });
  std::string line = "time: " + with_decimals(record.cpu_seconds, 0) + " s of the processor";
  for (const PhaseTime& time : phases) {
    line += (&time == &phases.front() ? ": " : ", ") + time.phase;
    if (!time.effect.empty()) line += " of " + time.effect;
    line += " " + with_decimals(100.0 * time.cpu / record.cpu_seconds, 0) + " %";
  }
  return line;
}

}  // namespace talus::io
