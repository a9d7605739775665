#include "talus/io/results/class_names.hpp"

#include <array>
#include <cmath>

#include "talus/base/text.hpp"
#include "talus/io/results/style.hpp"
#include "xml.hpp"

namespace talus::io {
namespace {

/// A column of a raster attribute table, with GDAL's numbers for its type and its use.
struct Column {
  const char* name;
  int type;  // 0 whole number, 1 number, 2 text
  int use;   // 2 name, 3 least value, 4 largest value, 5 both, 6 to 8 red, green, blue
};

constexpr Column kValue{"Value", 0, 5}, kLow{"From", 1, 3}, kHigh{"To", 1, 4}, kName{"Class", 2, 2};
constexpr std::array<Column, 3> kColour{{{"Red", 0, 6}, {"Green", 0, 7}, {"Blue", 0, 8}}};
constexpr double kLargest = 3.4e38;  // of the last class: an infinite number is none in this file

void add_columns(const Element& table, std::vector<Column> columns) {
  columns.insert(columns.end(), kColour.begin(), kColour.end());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Element field = table.add("FieldDefn");
    field.set("index", std::to_string(i));
    field.add("Name", columns[i].name);
    field.add("Type", std::to_string(columns[i].type));
    field.add("Usage", std::to_string(columns[i].use));
  }
}

/// @param values  of the columns before those of the colour
void add_row(const Element& table, std::size_t index, const std::vector<std::string>& values, const std::string& rgb) {
  const Element row = table.add("Row");
  row.set("index", std::to_string(index));
  for (const std::string& value : values) row.add("F", value);
  for (const int channel : channels_of(rgb)) row.add("F", std::to_string(channel));
}

/// Values that are classes: their names by number.
void add_named(const Element& band, const Map& map) {
  const Element names = band.add("CategoryNames");
  for (const std::string& name : map.classes) names.add("Category", name);
  const Element table = band.add("GDALRasterAttributeTable");
  table.set("tableType", "thematic");
  add_columns(table, {kValue, kName});
  add_row(table, 0, {"0", map.classes.front()}, "#ffffff");
  for (const LegendClass& one : classes_of(map))
    add_row(table, static_cast<std::size_t>(one.limit), {text_of(one.limit), one.label}, one.colour);
}

/// Values in classes between limits.
void add_ranges(const Element& band, const Map& map) {
  const Element table = band.add("GDALRasterAttributeTable");
  table.set("tableType", "athematic");
  add_columns(table, {kLow, kHigh, kName});
  double low = 0.0;
  std::size_t index = 0;
  for (const LegendClass& one : classes_of(map)) {
    const double high = std::isinf(one.limit) ? kLargest : one.limit;
    add_row(table, index++, {text_of(low), text_of(high), one.label}, one.colour);
    low = high;
  }
}

}  // namespace

std::string class_names_of(const Map& map) {
  if (!map.legend.names_in_file) return {};
  const XmlTree tree(CPLCreateXMLNode(nullptr, CXT_Element, "PAMDataset"), CPLDestroyXMLNode);
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    if (!map.classes.empty() && map.bands[b].unit != "class") continue;
    const Element band = Element(tree.get()).add("PAMRasterBand");
    band.set("band", std::to_string(b + 1));
    map.classes.empty() ? add_ranges(band, map) : add_named(band, map);
  }
  return xml_text(*tree);
}

}  // namespace talus::io
