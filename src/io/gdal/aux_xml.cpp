#include "aux_xml.hpp"

#include <cpl_minixml.h>
#include <cpl_string.h>

#include <algorithm>
#include <initializer_list>

#include "dataset.hpp"

namespace talus::io {

namespace {

bool is_one_of(const CPLXMLNode& node, std::initializer_list<const char*> names) {
  return std::ranges::any_of(names, [&](const char* name) { return EQUAL(node.pszValue, name); });
}

bool prune(CPLXMLNode& parent);

/// Whether a node changes the raster. Removes from it what does not.
bool node_counts(CPLXMLNode& node) {
  if (node.eType != CXT_Element) return node.eType == CXT_Attribute;
  if (is_one_of(node, {"?xml", "Description", "CategoryNames", "ColorTable", "Minimum", "Maximum", "Histograms",
                       "GDALRasterAttributeTable"}))
    return false;
  if (EQUAL(node.pszValue, "ColorInterp")) return EQUAL(CPLGetXMLValue(&node, "", ""), "Alpha");  // a mask
  if (EQUAL(node.pszValue, "MDI")) return EQUAL(CPLGetXMLValue(&node, "key", ""), "NODATA_VALUES");
  if (EQUAL(node.pszValue, "Metadata")) {
    const char* const domain = CPLGetXMLValue(&node, "domain", "");
    return *domain == '\0' ? prune(node) : EQUAL(domain, "xml:ESRI");  // which has a place and a system
  }
  return is_one_of(node, {"PAMDataset", "PAMRasterBand", "Subdataset"}) ? prune(node) : true;
}

/// Removes the nodes below `parent` that do not count. Whether any but attributes is left.
bool prune(CPLXMLNode& parent) {
  bool any = false;
  for (CPLXMLNode** link = &parent.psChild; *link != nullptr;) {
    CPLXMLNode* const child = *link;
    if (node_counts(*child)) {
      any = any || child->eType != CXT_Attribute;
      link = &child->psNext;
    } else {
      *link = child->psNext;
      child->psNext = nullptr;
      CPLDestroyXMLNode(child);
    }
  }
  return any;
}

}  // namespace

std::string aux_that_counts(const std::string& text) {
  const GdalMessages quiet;
  CPLXMLNode* const read = CPLParseXMLString(text.c_str());
  if (read == nullptr) return {};
  const CPLXMLTreeCloser all(CPLCreateXMLNode(nullptr, CXT_Element, "all"));
  CPLAddXMLChild(all.get(), read);
  if (!prune(*all)) return {};
  char* const left = CPLSerializeXMLTree(all->psChild);
  std::string counted(left);
  CPLFree(left);
  return counted;
}

}  // namespace talus::io
