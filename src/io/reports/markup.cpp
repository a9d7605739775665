#include "markup.hpp"

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

Markup operator""_html(const char* literal, std::size_t size) {
  Markup page;
  page.text_.assign(literal, size);
  return page;
}

}  // namespace talus::io
