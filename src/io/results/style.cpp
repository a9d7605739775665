#include "talus/io/results/style.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "io/gdal/map_raster.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/class_names.hpp"
#include "xml.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kColours = 6;
using Colours = std::array<const char*, kColours>;
constexpr const char* kClear = "#ffffff";  // of a class without a colour

// Six colours each of plasma and viridis of matplotlib (CC0) and of YlGnBu and PuBuGn of ColorBrewer (Apache); none is
// grey, as the hillshade below is. The darkest of plasma and of PuBuGn are darker here: without the red cones
// (protanopia) they would be too near to those before them. Return periods (PuBuGn) are drawn over the classes of
// hazard and beside energies (plasma), and have no colour of these. How far apart the colours are for the colour-blind
// is tested (tests/io/style_test.cpp).
constexpr Colours kPlasma{"#f0f921", "#fca636", "#e16462", "#b12a90", "#6a00a8", "#08054f"};
constexpr Colours kPuBuGnFromDark{"#00231b", "#014c3b", "#017268", "#3e94c3", "#93b7d7", "#e0daec"};
constexpr Colours kViridis{"#fde725", "#7ad151", "#22a884", "#2a788e", "#414487", "#440154"};
constexpr Colours kYlGnBu{"#c7e9b4", "#7fcdbb", "#41b6c4", "#1d91c0", "#225ea8", "#0c2c84"};
// The classes of the Swiss matrix: yellow and white, yellow, blue, red; further ones, should there be any, darker.
constexpr Colours kHazardClasses{"#fff9c4", "#ffd600", "#2979ff", "#d50000", "#7f0000", "#3e0000"};

// Changes have blues and oranges of ColorBrewer, which the colour-blind can tell apart; around 0 there is no colour.
constexpr std::array kChange{"#08519c", "#3182bd", "#9ecae1", kClear, "#fdae6b", "#e6550d", "#a63603"};
constexpr std::array kChangeReversed{"#a63603", "#e6550d", "#fdae6b", kClear, "#9ecae1", "#3182bd", "#08519c"};

std::span<const char* const> colours(Palette palette) {
  switch (palette) {
    case Palette::Plasma:
      return kPlasma;
    case Palette::PuBuGnFromDark:
      return kPuBuGnFromDark;
    case Palette::Viridis:
      return kViridis;
    case Palette::YlGnBu:
      return kYlGnBu;
    case Palette::HazardClasses:
      return kHazardClasses;
    case Palette::Change:
      return kChange;
    case Palette::ChangeReversed:
      return kChangeReversed;
  }
  throw std::logic_error("a palette without colours");
}

/// The number of a band, from 1.
std::size_t number_of_band(const Map& map, const std::string& name) {
  const auto found = std::ranges::find(map.bands, name, &Map::Band::name);
  if (found == map.bands.end()) throw std::logic_error(map.name + " has no band " + name);
  return static_cast<std::size_t>(found - map.bands.begin()) + 1;
}

/// The number of the band that is shown.
std::size_t shown_band(const Map& map) {
  return map.legend.band.empty() ? 1 : number_of_band(map, map.legend.band);
}

/// A limit in a label: never with an exponent.
std::string plain(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed).ptr;
  return {digits.begin(), end};
}

/// The classes of a map whose values are classes, from 1.
std::vector<LegendClass> named_classes(const Map& map) {
  const auto all = colours(map.legend.palette);
  std::vector<LegendClass> classes;
  for (std::size_t i = 1; i < map.classes.size(); ++i)
    classes.push_back({static_cast<double>(i), map.classes[i], all[std::min(i, kColours) - 1]});
  return classes;
}

/// The classes of a map of changes, by their names.
std::vector<LegendClass> named_changes(const Map& map) {
  std::vector<LegendClass> classes = classes_of(map.legend, false);
  for (std::size_t i = 0; i < classes.size(); ++i) classes[i].label = map.classes[i];
  return classes;
}

std::string value_text(double limit) {
  return std::isinf(limit) ? "inf" : text_of(limit);
}

void add_item(const Element& to, const LegendClass& item, int alpha) {
  to.add("item")
      .set("value", value_text(item.limit))
      .set("label", item.label)
      .set("color", item.colour)
      .set("alpha", std::to_string(alpha));
}

/// The label of 0: no colour.
std::string zero_label(const Map& map) {
  if (!map.classes.empty()) return map.classes[0];
  return map.legend.unit.empty() ? "0" : "0 " + map.legend.unit;
}

void add_items(const Element& shader, const Map& map) {
  if (map.legend.has_zero) add_item(shader, {0.0, zero_label(map), kClear}, 0);
  for (const LegendClass& item : classes_of(map)) add_item(shader, item, item.colour == kClear ? 0 : 255);
}

Element add_renderer(const Element& pipe, const char* type, std::size_t band, const char* opacity) {
  const Element renderer = pipe.add("rasterrenderer");
  renderer.set("type", type).set("band", std::to_string(band)).set("opacity", opacity);
  renderer.set("alphaBand", "-1").set("nodataColor", "");
  return renderer;
}

void add_classes(const Element& pipe, const Map& map) {
  const std::string minimum = text_of(std::min(0.0, map.legend.limits.front()));
  const std::string maximum = text_of(map.legend.limits.back());
  const Element renderer = add_renderer(pipe, "singlebandpseudocolor", shown_band(map), "0.8");
  renderer.set("classificationMin", minimum).set("classificationMax", maximum).add("rasterTransparency");
  const Element origin = renderer.add("minMaxOrigin");
  origin.add("limits", "None");
  origin.add("extent", "WholeRaster");
  origin.add("statAccuracy", "Estimated");
  const Element shader = renderer.add("rastershader").add("colorrampshader");
  shader.set("colorRampType", "DISCRETE").set("classificationMode", "1").set("clip", "0");
  shader.set("minimumValue", minimum).set("maximumValue", maximum);
  add_items(shader, map);
}

/// A style around its renderer, which `add` makes.
template <class Add>
std::string raster_style(Add add) {
  const QgisDocument document;
  const Element pipe = document.root().set("styleCategories", "Symbology").add("pipe");
  add(pipe);
  pipe.add("brightnesscontrast").set("brightness", "0").set("contrast", "0");
  pipe.add("huesaturation").set("saturation", "0").set("grayscaleMode", "0").set("colorizeOn", "0");
  pipe.add("rasterresampler").set("maxOversampling", "2");
  document.root().add("blendMode", "0");
  return document.text();
}

}  // namespace

std::array<int, 3> channels_of(const std::string& colour) {
  const auto channel = [&](std::size_t at) { return std::stoi(colour.substr(at, 2), nullptr, 16); };
  return {channel(1), channel(3), channel(5)};
}

std::vector<LegendClass> classes_of(const Legend& legend, bool to_one) {
  const std::string unit = legend.unit.empty() ? "" : " " + legend.unit;
  const std::size_t count = legend.limits.size() + (to_one ? 0 : 1);
  const auto all = colours(legend.palette);
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  std::vector<LegendClass> classes;
  std::string below;
  for (std::size_t i = 0; i < legend.limits.size(); ++i) {
    const std::string limit = plain(legend.limits[i] * legend.factor);
    const std::string label = below.empty() ? "up to " + limit : below + " to " + limit;
    classes.push_back({i + 1 == count ? kOpen : legend.limits[i], label + unit, all[i + all.size() - count]});
    below = limit;
  }
  if (!to_one) classes.push_back({kOpen, "above " + below + unit, all.back()});
  return classes;
}

std::vector<LegendClass> classes_of(const Map& map) {
  if (map.classes.empty()) return classes_of(map.legend, map.kind == Map::Kind::Probability);
  return map.legend.limits.front() < 0.0 ? named_changes(map) : named_classes(map);
}

std::string style_of(const Map& map) {
  if (map.legend.limits.empty()) throw std::logic_error(map.name + " has no legend");
  return raster_style([&map](const Element& pipe) { add_classes(pipe, map); });
}

std::string style_of(const Map& map, const Map::Mark& mark) {
  return raster_style([&](const Element& pipe) {
    const Element renderer = add_renderer(pipe, "paletted", number_of_band(map, mark.band), "1");
    renderer.add("rasterTransparency");
    const Element entry = renderer.add("colorPalette").add("paletteEntry");
    entry.set("value", "1").set("color", mark.colour).set("alpha", "255").set("label", mark.label);
  });
}

std::string mark_style_name(const std::string& map, std::string band) {
  std::ranges::replace(band, ' ', '_');
  return map + "_" + band + ".qml";
}

void write_style(const std::filesystem::path& folder, const Map& map) {
  write_text(folder / (map.name + ".qml"), style_of(map));
  if (const std::string names = class_names_of(map); !names.empty())
    write_text(folder / (map.name + ".tif.aux.xml"), names);
  for (const Map::Mark& mark : map.marks)
    if (MapRaster((folder / (map.name + ".tif")).string(), mark.band).any_positive())
      write_text(folder / mark_style_name(map.name, mark.band), style_of(map, mark));
}

}  // namespace talus::io
