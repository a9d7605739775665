#pragma once
#include <string>
#include <string_view>

namespace talus::io {

/// A piece of HTML or SVG. Text that is added to it becomes text: what stands between < and > is escaped, whatever name
/// of the input it is. Only a literal in the source code, written "<td>"_html or added to a piece, is markup.
///
///   page += "<td>"_html + name + "</td>";
class Markup {
 public:
  Markup() = default;

  /// The finished page.
  const std::string& text() const { return text_; }
  bool empty() const { return text_.empty(); }

  Markup& operator+=(const Markup& piece);
  Markup& operator+=(std::string_view text);  ///< escaped
  template <std::size_t N>
  Markup& operator+=(const char (&literal)[N]) {
    text_.append(literal, N - 1);
    return *this;
  }
  Markup& add_value(std::string_view text);  ///< of an attribute, between its quotes

 private:
  friend Markup operator""_html(const char* literal, std::size_t size);
  std::string text_;
};

Markup operator""_html(const char* literal, std::size_t size);

/// A text in Markdown without markup of HTML: a < that would begin a tag is escaped.
std::string markdown_without_html(std::string_view text);

template <class Piece>
Markup operator+(Markup page, const Piece& piece) {
  page += piece;
  return page;
}

}  // namespace talus::io
