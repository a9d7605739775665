#pragma once
#include "io/files/json.hpp"

namespace talus::io {

/// Whether a run.json is of `talus profile`: among its inputs is a profile, or a line over a DEM. Never throws.
bool is_of_profile(const Json& run);

}  // namespace talus::io
