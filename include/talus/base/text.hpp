#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The shortest decimal text that reads back as exactly this number: "0.25", "30", "1e-05".
std::string text_of(double value);

/// "a, b, c".
std::string joined(std::span<const std::string> words);

/// The one of `names` that is spelt most like `word`, letters of either case being the same; empty where none is near.
/// Near: at most 2 letters, or a third of the word, inserted, left out or exchanged (Levenshtein).
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// "; did you mean 'density'? (known: axes, density)" for a name that is none of `names`.
std::string known_names(std::string_view word, std::span<const std::string> names);

}  // namespace talus
