#pragma once
#include <span>
#include <string>

namespace talus::io {

/// A part of a file name that stands for an id: no two of `ids` get the same, also where capitals count as small
/// letters.
///
/// Letters, digits, `-`, `_` and all beyond ASCII stay; any other character becomes `_`. If that is the same for
/// another id, or longer than 120 bytes, `-` and eight hexadecimal digits follow: the beginning of SHA-256 of the id.
/// Throws InputError if the name is still that of another id. docs/barrier.md, "Names of the files".
std::string file_name_of(const std::string& id, std::span<const std::string> ids);

}  // namespace talus::io
