#pragma once
#include <string_view>

namespace talus {

/// Version of the program, for instance "0.1.0": that of the build.
std::string_view version();

}  // namespace talus
