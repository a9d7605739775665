#pragma once
#include <string>

#include "toml_tree.hpp"

namespace talus::io {

/// What the TOML file of a command is: of `talus run`, of `talus profile`, or of `talus calibrate` and its like.
enum class FileKind { Scenario, Profile, Campaign };

/// Throws InputError where keys of a file are those of another kind, and none is of the expected one: each of them
/// would be a fault otherwise.
void refuse_other_kind(const TomlValue& root, const std::string& file, FileKind expected);

}  // namespace talus::io
