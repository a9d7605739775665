#pragma once
#include <optional>
#include <string>
#include <vector>

#include "table_reader.hpp"
#include "talus/terrain/surface.hpp"

namespace talus::io {

/// Reads the key `surface` of a file. Any other value than "bilinear" and "creased" is a fault.
std::optional<SurfaceKind> read_surface(TableReader& top);

/// The kind that the flag --surface names. Any other value is a fault.
std::optional<SurfaceKind> surface_of_flag(const std::string& value, std::vector<std::string>& faults);

}  // namespace talus::io
