#pragma once
#include <string>

#include "markup.hpp"

/// The frame of every page: head, style, header, footer. docs/report.md.
namespace talus::io {

/// What a page says of itself.
struct PageFrame {
  std::string kind;    ///< "diagnosis": what made the page, `talus KIND`
  std::string title;   ///< of the window and at the top
  std::string footer;  ///< one line at the end, after the version
  Markup script{};     ///< JavaScript of ours; empty for none
  bool wide = false;   ///< for tables of many columns
};

/// A whole page. It is self-contained: a policy in its head forbids the browser to load anything, and to run any other
/// script than the one of the frame.
std::string page_of(const PageFrame& frame, const Markup& body);

}  // namespace talus::io
