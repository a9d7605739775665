// Styles of all rasters of the table, read with GDAL's reader of XML.
#include "talus/io/results/style.hpp"

#include <cpl_minixml.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "talus/products/raster_table.hpp"

namespace talus::io {
namespace {

/// Every map of a run and of a hazard, without values.
std::vector<Map> all_maps() {
  std::vector<Map> maps;
  const RunCounts run{100, 10.0, thresholds_of({30.0, 300.0}, {1.0}), 1.0, 1.0, 0.0, true, true};
  for (const RunRaster& raster : run_rasters()) {
    maps.push_back(raster.map);
    maps.back().bands = bands_of(raster, run);
  }
  for (HazardMap& of : hazard_maps_of({EnergyBins({30.0, 300.0}), {}}, {})) maps.push_back(std::move(of.map));
  return maps;
}

using Tree = std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)>;

Tree tree_of(const Map& map) {
  return {CPLParseXMLString(style_of(map).c_str()), CPLDestroyXMLNode};
}

Map map_of(const std::string& name) {
  for (const Map& map : all_maps())
    if (map.name == name) return map;
  ADD_FAILURE() << "no map " << name;
  return {};
}

TEST(Style, XmlWithRisingClasses) {
  for (const Map& map : all_maps()) {
    const Tree tree = tree_of(map);
    ASSERT_NE(tree, nullptr) << map.name;
    const CPLXMLNode* shader = CPLGetXMLNode(tree.get(), "=qgis.pipe.rasterrenderer.rastershader.colorrampshader");
    ASSERT_NE(shader, nullptr) << map.name;
    double last = -1.0;
    for (const CPLXMLNode* item = shader->psChild; item != nullptr; item = item->psNext) {
      if (item->eType != CXT_Element) continue;
      const double value = std::atof(CPLGetXMLValue(item, "value", ""));
      EXPECT_GT(value, last) << map.name;
      EXPECT_STREQ(CPLGetXMLValue(item, "alpha", ""), value == 0.0 ? "0" : "255") << map.name;
      last = value;
    }
    EXPECT_TRUE(std::isinf(last) || !map.classes.empty()) << "every value has a class: " << map.name;
  }
}

TEST(Style, ShownBands) {  // docs/products.md: the P95 of each quantity
  for (const auto& [name, band] : {std::pair{"energy", "3"},
                                   {"velocity", "3"},
                                   {"jump_height", "3"},
                                   {"impact_probability", "1"},
                                   {"height_exceedance", "1"},
                                   {"intensity_T30", "1"}})
    EXPECT_STREQ(CPLGetXMLValue(tree_of(map_of(name)).get(), "=qgis.pipe.rasterrenderer.band", ""), band) << name;
}

TEST(Style, LabelsWithUnits) {
  const std::string energy = style_of(map_of("energy")), probability = style_of(map_of("impact_probability"));
  EXPECT_NE(energy.find("value=\"100\" label=\"30 to 100 kJ\" color=\"#fca636\""), std::string::npos) << energy;
  EXPECT_NE(energy.find("value=\"inf\" label=\"above 3000 kJ\" color=\"#0d0887\""), std::string::npos) << energy;
  EXPECT_NE(probability.find("value=\"inf\" label=\"10 to 100 %\""), std::string::npos) << probability;
}

TEST(Style, NamesOfClassesAreEscaped) {
  Map map = map_of("hazard_class");
  map.classes = {"none", "\"low\" < 30 & rare"};
  EXPECT_NE(style_of(map).find("label=\"&quot;low&quot; &lt; 30 &amp; rare\""), std::string::npos) << style_of(map);
}

TEST(Style, WithoutALegendItIsAFault) {
  Map map = map_of("energy");
  map.legend.band = "P97";
  EXPECT_THROW(style_of(map), std::logic_error);
  map.legend = {};
  EXPECT_THROW(style_of(map), std::logic_error);
}

}  // namespace
}  // namespace talus::io
