#pragma once
#include <cpl_minixml.h>

#include <memory>
#include <string>
#include <string_view>

namespace talus::io {

/// An element of XML; adds attributes and elements to it. Every text is escaped when it is written.
class Element {
 public:
  explicit Element(CPLXMLNode* node) : node_(node) {}

  Element add(const char* name) const { return Element(CPLCreateXMLNode(node_, CXT_Element, name)); }
  void add(const char* name, const std::string& text) const { CPLCreateXMLElementAndValue(node_, name, text.c_str()); }
  const Element& set(const char* attribute, const std::string& value) const {
    CPLAddXMLAttributeAndValue(node_, attribute, value.c_str());
    return *this;
  }
  void text(const std::string& text) const { CPLCreateXMLNode(node_, CXT_Text, text.c_str()); }
  void append_to(CPLXMLNode* sibling) const { CPLAddXMLSibling(sibling, node_); }
  void add_copy_of(const CPLXMLNode& other) const;
  /// Adds copies of the elements inside another.
  void add_children_of(const CPLXMLNode& other) const;

 private:
  CPLXMLNode* node_;
};

/// A tree of XML, with those beside its root.
using XmlTree = std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)>;

std::string xml_text(const CPLXMLNode& tree);

/// Null if the text is no XML.
XmlTree parsed_xml(const std::string& text);

/// A document with the root element `qgis`.
class QgisDocument {
 public:
  QgisDocument();
  Element root() const { return root_; }
  std::string text() const;

 private:
  XmlTree tree_;
  Element root_;
};

}  // namespace talus::io
