#include "talus/io/results/style.hpp"

#include <cpl_minixml.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <regex>
#include <stdexcept>
#include <string_view>

#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kColours = 6;
using Colours = std::array<const char*, kColours>;

// Six colours each of matplotlib's plasma, viridis and cividis (CC0), from light to dark in even steps, also for the
// colour-blind.
constexpr Colours kPlasma{"#f0f921", "#fca636", "#e16462", "#b12a90", "#6a00a8", "#0d0887"};
constexpr Colours kPlasmaFromDark{"#0d0887", "#6a00a8", "#b12a90", "#e16462", "#fca636", "#f0f921"};
constexpr Colours kViridis{"#fde725", "#7ad151", "#22a884", "#2a788e", "#414487", "#440154"};
constexpr Colours kCividis{"#ffea46", "#cbba69", "#958f78", "#666970", "#31446b", "#00204d"};
// The classes of the Swiss matrix: yellow and white, yellow, blue, red; further ones, should there be any, darker.
constexpr Colours kHazardClasses{"#fff9c4", "#ffd600", "#2979ff", "#d50000", "#7f0000", "#3e0000"};

const Colours& colours_of(Palette palette) {
  switch (palette) {
    case Palette::Plasma:
      return kPlasma;
    case Palette::PlasmaFromDark:
      return kPlasmaFromDark;
    case Palette::Viridis:
      return kViridis;
    case Palette::Cividis:
      return kCividis;
    case Palette::HazardClasses:
      return kHazardClasses;
  }
  throw std::logic_error("a palette without colours");
}

/// The number of the band that is shown, from 1.
std::size_t shown_band(const Map& map) {
  if (map.legend.band.empty()) return 1;
  const auto found =
      std::ranges::find_if(map.bands, [&map](const Map::Band& band) { return band.name == map.legend.band; });
  if (found == map.bands.end()) throw std::logic_error(map.name + " has no band " + map.legend.band);
  return static_cast<std::size_t>(found - map.bands.begin()) + 1;
}

/// A limit in a label: never with an exponent.
std::string plain(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed).ptr;
  return {digits.begin(), end};
}

/// A class of the legend: its upper limit, which belongs to it.
struct Item {
  std::string value, label;
  const char* colour;
};

std::vector<Item> named_items(const Map& map) {
  const Colours& colours = colours_of(map.legend.palette);
  std::vector<Item> items;
  for (std::size_t i = 1; i < map.classes.size(); ++i)
    items.push_back({std::to_string(i), map.classes[i], colours[std::min(i, kColours) - 1]});
  return items;
}

std::vector<Item> items_by_limit(const Map& map, const std::string& unit) {
  const Legend& legend = map.legend;
  const bool to_one = map.kind == Map::Kind::Probability;  // nothing is above 100 %
  const std::size_t classes = legend.limits.size() + (to_one ? 0 : 1);
  const Colours& colours = colours_of(legend.palette);
  std::vector<Item> items;
  std::string below;
  for (std::size_t i = 0; i < legend.limits.size(); ++i) {
    const std::string limit = plain(legend.limits[i] * legend.factor);
    const std::string label = below.empty() ? "up to " + limit : below + " to " + limit;
    items.push_back(
        {i + 1 == classes ? "inf" : text_of(legend.limits[i]), label + unit, colours[i + kColours - classes]});
    below = limit;
  }
  if (!to_one) items.push_back({"inf", "above " + below + unit, colours.back()});
  return items;
}

/// An element of XML; adds attributes and elements to it.
class Element {
 public:
  explicit Element(CPLXMLNode* node) : node_(node) {}

  Element add(const char* name) const { return Element(CPLCreateXMLNode(node_, CXT_Element, name)); }
  void add(const char* name, const char* text) const { CPLCreateXMLElementAndValue(node_, name, text); }
  const Element& set(const char* attribute, const std::string& value) const {
    CPLAddXMLAttributeAndValue(node_, attribute, value.c_str());
    return *this;
  }

 private:
  CPLXMLNode* node_;
};

void add_item(const Element& to, const Item& item, int alpha) {
  to.add("item")
      .set("value", item.value)
      .set("label", item.label)
      .set("color", item.colour)
      .set("alpha", std::to_string(alpha));
}

void add_items(const Element& shader, const Map& map) {
  const std::string unit = map.legend.unit.empty() ? "" : " " + map.legend.unit;
  const bool named = !map.classes.empty();
  add_item(shader, {"0", named ? map.classes[0] : "0" + unit, "#ffffff"}, 0);  // no value: not drawn
  for (const Item& item : named ? named_items(map) : items_by_limit(map, unit)) add_item(shader, item, 255);
}

void add_renderer(const Element& pipe, const Map& map) {
  const std::string maximum = text_of(map.legend.limits.back());
  const Element renderer = pipe.add("rasterrenderer");
  renderer.set("type", "singlebandpseudocolor").set("band", std::to_string(shown_band(map))).set("opacity", "0.8");
  renderer.set("alphaBand", "-1").set("nodataColor", "").set("classificationMin", "0");
  renderer.set("classificationMax", maximum).add("rasterTransparency");
  const Element origin = renderer.add("minMaxOrigin");
  origin.add("limits", "None");
  origin.add("extent", "WholeRaster");
  origin.add("statAccuracy", "Estimated");
  const Element shader = renderer.add("rastershader").add("colorrampshader");
  shader.set("colorRampType", "DISCRETE").set("classificationMode", "1").set("clip", "0").set("minimumValue", "0");
  shader.set("maximumValue", maximum);
  add_items(shader, map);
}

}  // namespace

std::string style_of(const Map& map) {
  if (map.legend.limits.empty()) throw std::logic_error(map.name + " has no legend");
  const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> type(
      CPLCreateXMLNode(nullptr, CXT_Literal, "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"),
      CPLDestroyXMLNode);
  CPLXMLNode* const root = CPLCreateXMLNode(nullptr, CXT_Element, "qgis");
  CPLAddXMLSibling(type.get(), root);
  const Element qgis(root);
  const Element pipe = qgis.set("version", "3.22.0").set("styleCategories", "Symbology").add("pipe");
  add_renderer(pipe, map);
  pipe.add("brightnesscontrast").set("brightness", "0").set("contrast", "0");
  pipe.add("huesaturation").set("saturation", "0").set("grayscaleMode", "0").set("colorizeOn", "0");
  pipe.add("rasterresampler").set("maxOversampling", "2");
  qgis.add("blendMode", "0");
  const std::unique_ptr<char, decltype(&VSIFree)> text(CPLSerializeXMLTree(type.get()), VSIFree);
  return std::regex_replace(text.get(), std::regex(" />"), "/>");  // the bytes of earlier versions
}

void write_style(const std::filesystem::path& folder, const Map& map) {
  write_text(folder / (map.name + ".qml"), style_of(map));
}

}  // namespace talus::io
