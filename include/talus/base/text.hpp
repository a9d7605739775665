#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The shortest decimal text that reads back as exactly this number: "0.25", "30", "1e-05".
std::string text_of(double value);

/// The number at the beginning of a text, whatever the locale of the program; NaN if there is none.
double number_in(std::string_view text);

/// The decimal number that a whole text is, whatever the locale: "500", "1e3"; nothing if there is anything else in it:
/// blanks, a plus sign, 0x, inf, nan.
std::optional<double> decimal_number(std::string_view text);

/// A number for a file with at most `digits` significant digits, like "%.4g" of printf for 4: "0.1235", "1.235e+06".
std::string significant(double value, int digits);

/// A number for a reader: as `significant`, but with all digits before its point: "1235000", not "1.235e+06".
std::string with_digits(double value, int digits);

/// Smallest share that is stated [-]: a fitted law gives 1e-280 as well, but no data can support it.
inline constexpr double kSmallestShare = 1e-9;

/// A share in percent with at most `digits` significant digits: "21.6 %" for 0.2158 and 3; "below 1e-07 %" for less
/// than `kSmallestShare`. A part near the whole has four digits or more, and is never "100 %" ("99.96 %").
std::string percent(double share, int digits = 3);

/// A number with `decimals` digits after the point, like "%.1f" of printf for 1: "12.0".
std::string with_decimals(double value, int decimals);

/// A number for a reader: three digits, large ones with their thousands apart and without an exponent: "2 360".
std::string readable(double number);

/// A whole number with its thousands apart: "47 850".
std::string grouped(double number);

/// A text filled up with blanks to a width [bytes]; a longer text is unchanged.
std::string padded(std::string text, std::size_t width);

/// A text for HTML, SVG or XML, between tags: <, > and & become entities.
std::string escaped(std::string_view text);

/// A text as a field of a CSV file: in quotation marks if needed.
std::string csv_field(const std::string& text);

/// A number as a field of a CSV file, with six digits; empty if it is NaN or infinite.
std::string csv_field(double value);

/// The words in one text: "a, b, c".
std::string joined(std::span<const std::string> words);

/// The first eight words, and how many more there are: "a, b and 3 more".
std::string listed(std::span<const std::string> words);

/// Numbers as in a scenario file: "[30, 300]".
std::string list_text(const std::vector<double>& values);

/// The text with its capital letters (ASCII) as small ones.
std::string lowercase(std::string_view text);

/// The name with the spelling nearest to `word`, upper and lower case alike; empty if none is near. Near: at most 2
/// letters, or a third of the word if that is more, are inserted, left out or exchanged (Levenshtein distance).
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// "; did you mean 'density'? (known: axes, density)" for a word that is not in `names`.
std::string known_names(std::string_view word, std::span<const std::string> names);

}  // namespace talus
