#include "xml.hpp"

#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

namespace talus::io {
namespace {

/// A text without the control characters that XML 1.0 does not allow, and in UTF-8: else the document cannot be opened.
std::string allowed(std::string text) {
  if (CPLIsUTF8(text.data(), static_cast<int>(text.size())) == 0)
    for (char& c : text)
      if (static_cast<unsigned char>(c) >= 0x80) c = '?';
  std::erase_if(text, [](unsigned char c) { return c < 0x20 && c != '\t' && c != '\n' && c != '\r'; });
  return text;
}

}  // namespace

void Element::add_copy_of(const CPLXMLNode& other) const {
  CPLXMLNode one = other;
  one.psNext = nullptr;  // the element alone, without those after it
  CPLAddXMLChild(node_, CPLCloneXMLTree(&one));
}

void Element::add_children_of(const CPLXMLNode& other) const {
  for (const CPLXMLNode* child = other.psChild; child != nullptr; child = child->psNext)
    if (child->eType == CXT_Element) add_copy_of(*child);
}

QgisDocument::QgisDocument()
    : tree_(CPLCreateXMLNode(nullptr, CXT_Literal, "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"),
            CPLDestroyXMLNode),
      root_(CPLCreateXMLNode(nullptr, CXT_Element, "qgis")) {
  root_.append_to(tree_.get());
  root_.set("version", "3.22.0");
}

std::string QgisDocument::text() const {
  std::string text = xml_text(*tree_);
  for (std::size_t at = text.find(" />"); at != std::string::npos; at = text.find(" />", at)) text.erase(at, 1);
  return text;  // QGIS writes "/>" without a blank, too
}

std::string xml_text(const CPLXMLNode& tree) {
  const std::unique_ptr<char, decltype(&VSIFree)> text(CPLSerializeXMLTree(&tree), VSIFree);
  return allowed(text.get());
}

XmlTree parsed_xml(const std::string& text) {
  CPLPushErrorHandler(CPLQuietErrorHandler);
  XmlTree tree(CPLParseXMLString(text.c_str()), CPLDestroyXMLNode);
  CPLPopErrorHandler();
  return tree;
}

}  // namespace talus::io
