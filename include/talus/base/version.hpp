#pragma once
#include <string_view>

namespace talus {

/// Version of the program, for instance "0.1.0", as set by the build.
std::string_view version();

}  // namespace talus
