#include "recorded_profile.hpp"

#include <algorithm>

namespace talus::io {

bool is_of_profile(const Json& run) {
  if (!run.is_object() || !run.contains("inputs")) return false;
  return std::ranges::any_of(run.at("inputs"), [](const Json& input) {
    if (!input.is_object() || !input.contains("role")) return false;
    return input.at("role") == "profile" || input.at("role") == "line";
  });
}

}  // namespace talus::io
