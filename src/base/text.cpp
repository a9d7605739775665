#include "talus/base/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <system_error>

#include "talus/base/bounds.hpp"
#include "talus/base/expect.hpp"

namespace talus {

namespace {

constexpr std::size_t kLongestWord = 200;  // that is compared with names [byte]

std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t exchanged = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({exchanged, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string printed(double value, std::chars_format format, int precision) {
  std::array<char, 400> text;  // the longest double in fixed notation has 309 digits before the point
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value, format, precision);
  TALUS_EXPECT(error == std::errc{}, "a number has room");
  return {text.data(), end};
}

}  // namespace

std::string text_of(double value) {
  std::array<char, 32> text{};
  const bool whole = std::abs(value) < 1e15 && value == std::floor(value);  // 1000000, not 1e+06
  const auto end = whole ? std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr
                         : std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string significant(double value, int digits) {
  return printed(value, std::chars_format::general, digits);
}

std::string with_digits(double value, int digits) {
  const bool whole = std::abs(value) >= std::pow(10.0, digits) - 0.5 && std::abs(value) < 1e15;
  return whole ? with_decimals(value, 0) : significant(value, digits);
}

double number_in(std::string_view text) {
  double number = kNotGiven;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::optional<double> decimal_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::string percent(double share, int digits) {
  if (share > 0.0 && share < kSmallestShare) return "below " + with_digits(100.0 * kSmallestShare, digits) + " %";
  if (share >= 0.99995 && share < 1.0) return "above 99.99 %";
  return with_digits(100.0 * share, share < 0.995 ? digits : std::max(digits, 4)) + " %";
}

std::string with_decimals(double value, int decimals) {
  return printed(value, std::chars_format::fixed, decimals);
}

std::string readable(double number) {
  if (!(std::abs(number) >= 999.5 && std::abs(number) < 1e12)) return with_digits(number, 3);
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(number))) - 2.0);
  return grouped(std::round(number / unit) * unit);
}

std::string grouped(double number) {
  const std::string digits = with_decimals(std::round(std::abs(number)), 0);
  std::string text = number <= -0.5 ? "-" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += "\u00a0";
    text += digits[i];
  }
  return text;
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  return out;
}

std::string csv_field(const std::string& text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };  // readers cut outer ones off
  const bool outer_blank = !text.empty() && (blank(text.front()) || blank(text.back()));
  if (!outer_blank && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_field(double value) {
  return std::isfinite(value) ? significant(value, 6) : "";
}

std::string joined(std::span<const std::string> words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

std::string listed(std::span<const std::string> words) {
  constexpr std::size_t kShown = 8;
  const std::string shown = joined(words.first(std::min(kShown, words.size())));
  return words.size() > kShown ? shown + " and " + std::to_string(words.size() - kShown) + " more" : shown;
}

std::string list_text(const std::vector<double>& values) {
  std::vector<std::string> words;
  words.reserve(values.size());
  for (const double value : values) words.push_back(text_of(value));
  return "[" + joined(words) + "]";
}

std::string lowercase(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
  const std::string wanted = lowercase(word.substr(0, kLongestWord));
  std::string best;
  std::size_t least = std::max<std::size_t>(2, wanted.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t longer = std::max(wanted.size(), name.size()) - std::min(wanted.size(), name.size());
    if (longer >= least) continue;  // so many letters are inserted or left out at least
    const std::size_t d = distance(wanted, lowercase(name));
    if (d < least && d < name.size()) {
      least = d;
      best = name;
    }
  }
  return best;
}

std::string known_names(std::string_view word, std::span<const std::string> names) {
  const std::string near = nearest_name(word, names);
  return (near.empty() ? std::string() : "; did you mean '" + near + "'?") + " (known: " + joined(names) + ")";
}

}  // namespace talus
