#pragma once
#include <string>
#include <string_view>

namespace talus {

/// A text as one word of a shell's command line: in single quotes where it has characters that a shell would read.
std::string shell_word(std::string_view text);

}  // namespace talus
