#pragma once
#include <vector>

#include "io/files/json.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// The screens of a run.json, in map coordinates [m]; none if it has none. Throws InputError or Json::exception.
std::vector<Screen> recorded_screens(const Json& run);

}  // namespace talus::io
