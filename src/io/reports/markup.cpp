#include "markup.hpp"

#include <cctype>

#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

Markup& Markup::operator+=(const Markup& piece) {
  text_ += piece.text_;
  return *this;
}

Markup& Markup::operator+=(std::string_view text) {
  text_ += escaped(printable(text));
  return *this;
}

Markup& Markup::add_value(std::string_view text) {
  for (const char c : escaped(printable(text)))
    if (c == '"')
      text_ += "&quot;";
    else if (c == '\'')
      text_ += "&#39;";
    else
      text_ += c;
  return *this;
}

std::string markdown_without_html(std::string_view text) {
  std::string out;
  const std::string shown = printable(text);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const unsigned char next = i + 1 < shown.size() ? static_cast<unsigned char>(shown[i + 1]) : ' ';
    if (shown[i] == '<' && (std::isalpha(next) != 0 || next == '/' || next == '!' || next == '?'))
      out += "&lt;";
    else
      out += shown[i];
  }
  return out;
}

Markup operator""_html(const char* literal, std::size_t size) {
  Markup page;
  page.text_.assign(literal, size);
  return page;
}

}  // namespace talus::io
