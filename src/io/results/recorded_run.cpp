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

bool has_fitted_ground(const Json& run) {
  bool lists_numbers = false;  // earlier versions name the model alone
  for (const Json& setting : run.value("settings", Json::array())) {
    const std::string key = setting.at("key");
    if (key.starts_with(kFittedNumbers)) return true;
    lists_numbers = lists_numbers || key == "fit.file";
  }
  return !lists_numbers && std::ranges::any_of(run.value("inputs", Json::array()), [](const Json& input) {
    return input.value("role", "") == kFittedModel;
  });
}

bool counts_rotation(const Json& run) {
  for (const Json& setting : run.value("settings", Json::array()))
    if (setting.at("key") == "output.count_rotation") return setting.at("value") == "true";
  return false;
}

}  // namespace talus::io
