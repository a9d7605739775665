#pragma once
#include <string>
#include <vector>

#include "io/files/json.hpp"

namespace talus::io {

/// Names of the effects that acted in a run, from its run.json. Records of earlier versions do not say it: then those
/// that the settings give; wet-ground on its days alone.
std::vector<std::string> acting_in(const Json& run);

}  // namespace talus::io
