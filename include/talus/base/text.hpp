#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The shortest decimal text that reads back as exactly this number: "0.25", "30", "1e-05".
std::string text_of(double value);

/// So many significant digits at most, as "%.4g" of printf for 4: "0.1235", "12", "1.235e+06".
std::string with_digits(double value, int digits);

/// So many digits behind the point, as "%.1f" of printf for 1: "12.0".
std::string with_decimals(double value, int decimals);

/// A text with blanks behind it, up to a width [bytes]; a longer one as it is.
std::string padded(std::string text, std::size_t width);

/// A text for HTML, SVG or XML, between tags: <, > and & are spelt out.
std::string escaped(std::string_view text);

/// A text as a field of a CSV file: in quotation marks where it needs them.
std::string csv_field(const std::string& text);

/// A number as a field of a CSV file, six digits; empty where it is NaN or infinite.
std::string csv_field(double value);

/// "a, b, c".
std::string joined(std::span<const std::string> words);

/// The one of `names` that is spelt most like `word`, letters of either case being the same; empty where none is near.
/// Near: at most 2 letters, or a third of the word, inserted, left out or exchanged (Levenshtein).
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// "; did you mean 'density'? (known: axes, density)" for a name that is none of `names`.
std::string known_names(std::string_view word, std::span<const std::string> names);

}  // namespace talus
