#pragma once
#include <string>
#include <string_view>

namespace talus {

/// A text that may come from a file, for a terminal or a page: control characters, marks that turn the direction of
/// writing (U+202E) and bytes that are no UTF-8 are shown as "\x1b" or "\u202e" instead of being obeyed. Line ends and
/// tabs stay.
std::string printable(std::string_view text);

/// Whether all bytes of a text are UTF-8.
bool is_utf8(std::string_view text);

/// The first `most` bytes of a text, with "..." in the place of the rest; no character is cut.
std::string shortened(std::string_view text, std::size_t most);

}  // namespace talus
