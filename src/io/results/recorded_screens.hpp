#pragma once
#include <vector>

#include "io/files/json.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus::io {

/// The id and the lines of a screen or a barrier of a run.json, in map coordinates [m]; no lines in an earlier record
/// of a barrier. Throws InputError or Json::exception.
Screen recorded_line(const Json& json);

/// The screens of a run.json, in map coordinates [m]; none if it has none. Throws InputError or Json::exception.
std::vector<Screen> recorded_screens(const Json& run);

}  // namespace talus::io
