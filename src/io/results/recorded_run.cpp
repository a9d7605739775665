#include "recorded_run.hpp"

#include <algorithm>

namespace talus::io {

bool is_of_profile(const Json& run) {
  if (!run.is_object() || !run.contains("inputs")) return false;
  return std::ranges::any_of(run.at("inputs"), [](const Json& input) {
    if (!input.is_object() || !input.contains("role")) return false;
    return input.at("role") == "profile" || input.at("role") == "line";
  });
}

std::string plan_of_tally(const Json& run) {
  const std::string plan = run.value("plan", "");
  return run.contains("rounds") ? run.at("rounds").value("plan", plan) : plan;
}

bool counts_rotation(const Json& run) {
  for (const Json& setting : run.value("settings", Json::array()))
    if (setting.at("key") == "output.count_rotation") return setting.at("value") == "true";
  return false;
}

}  // namespace talus::io
