#pragma once
#include <string>
#include <string_view>

namespace talus {

/// Beginning of the hidden names that results have until they are complete: `.STEM.talus-`, with the process after it.
std::string hidden_prefix(std::string_view stem);

/// Name of a file or folder as a message gives it: "c.gpkg" for the hidden `.c.talus-123.gpkg`, any other as it is.
std::string final_name(std::string_view name);

}  // namespace talus
