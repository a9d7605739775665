#include "aux_xml.hpp"

#include <cpl_minixml.h>
#include <cpl_string.h>

#include <algorithm>
#include <cstdlib>
#include <initializer_list>

#include "dataset.hpp"

namespace talus::io {

namespace {

bool is_one_of(const CPLXMLNode& node, std::initializer_list<const char*> names) {
  return std::ranges::any_of(names, [&](const char* name) { return EQUAL(node.pszValue, name); });
}

bool prune(CPLXMLNode& parent, int band);

/// Whether a node changes the raster. Removes from it what does not. @param band  in which it stands, from 1; 0: none
bool node_counts(CPLXMLNode& node, int band) {
  if (node.eType != CXT_Element) return node.eType == CXT_Attribute;
  if (is_one_of(node, {"?xml", "Description", "CategoryNames", "ColorTable", "Minimum", "Maximum", "Histograms",
                       "GDALRasterAttributeTable"}))
    return false;
  if (EQUAL(node.pszValue, "ColorInterp"))  // whether a band is alpha, a mask of the first
    return band > 1 || EQUAL(CPLGetXMLValue(&node, "", ""), "Alpha");
  if (EQUAL(node.pszValue, "MDI")) return EQUAL(CPLGetXMLValue(&node, "key", ""), "NODATA_VALUES");
  if (EQUAL(node.pszValue, "Metadata")) {
    const char* const domain = CPLGetXMLValue(&node, "domain", "");
    return *domain == '\0' ? prune(node, band) : EQUAL(domain, "xml:ESRI");  // which has a place and a system
  }
  if (EQUAL(node.pszValue, "PAMRasterBand")) return prune(node, std::atoi(CPLGetXMLValue(&node, "band", "1")));
  return is_one_of(node, {"PAMDataset", "Subdataset"}) ? prune(node, band) : true;
}

/// Removes the nodes below `parent` that do not count. Whether any but attributes is left.
bool prune(CPLXMLNode& parent, int band) {
  bool any = false;
  for (CPLXMLNode** link = &parent.psChild; *link != nullptr;) {
    CPLXMLNode* const child = *link;
    if (node_counts(*child, band)) {
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
  if (!prune(*all, 0)) return {};
  char* const left = CPLSerializeXMLTree(all->psChild);
  std::string counted(left);
  CPLFree(left);
  return counted;
}

}  // namespace talus::io
