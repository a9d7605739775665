#include "talus/io/results/vector_style.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include "io/gdal/regular_file.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/style.hpp"
#include "talus/products/hazard_table.hpp"
#include "talus/products/raster_table.hpp"
#include "xml.hpp"

namespace talus::io {
namespace {

enum class Symbol { Point, Line, Area };

/// How the features of a layer are drawn.
struct Look {
  Symbol symbol;
  std::string value;  ///< expression of QGIS for what the colour shows
  Legend legend;
  double smallest, largest;  ///< size or width in the first and the last class [mm]
  std::string never = "";    ///< label of a white class of its own for 1e99; empty: there is none
};

/// The legend of a raster, without its band.
Legend legend_of(const std::string& name) {
  for (const RunRaster& raster : run_rasters())
    if (raster.map.name == name) return raster.map.legend;
  for (const HazardRaster& raster : hazard_rasters())
    if (raster.map.name == name) return raster.map.legend;
  throw std::logic_error("no raster " + name);
}

Legend depth_legend() {
  return {{0.03, 0.1, 0.3, 1.0, 3.0}, 1.0, "m", Palette::YlGnBu};
}

Legend slope_legend() {
  return {{45.0, 50.0, 55.0, 60.0, 70.0}, 1.0, "deg", Palette::Viridis};
}

/// Objects with no hit per year have no return period and a class of their own. Those off the map, and those without a
/// hit of which a part is not assessed (no upper bound), have no class: they may be hit.
constexpr const char* kReturnPeriod =
    R"(CASE WHEN "frequency_upper" IS NULL THEN "return_period" ELSE coalesce("return_period", 1e99) END)";
/// [kJ], of the largest speed of the path and the mass at its end: too low for a block that broke after it was fastest.
/// The layer has no mass of each place.
constexpr const char* kLargestEnergy = R"(0.0005 * "mass_kg" * "max_speed_ms" ^ 2)";

constexpr const char* kNoHit = "no hit counted in this run";  // none, or of blocks of sources with a frequency of 0
constexpr const char* kNoCrossing = "no crossing";
constexpr const char* kNoDesign = "too few crossings for a design";

// Lines at one place, as a road that is an object, a screen and the line of a net, are drawn above each other, the
// upper ones thinner: all are seen.
Look look_of(StyledLayer layer) {
  switch (layer) {
    case StyledLayer::Stops:
      return {Symbol::Point, kLargestEnergy, legend_of("energy"), 1.2, 2.4};
    case StyledLayer::Exits:
      return {Symbol::Point, "\"energy_kj\"", legend_of("energy"), 1.6, 2.8};
    case StyledLayer::Trajectories:
      return {Symbol::Line, "\"max_speed_ms\"", legend_of("velocity"), 0.25, 0.25};
    case StyledLayer::Screens:
      return {Symbol::Line, "coalesce(\"energy_kj_p95\", 1e99)", legend_of("energy"), 3.0, 3.0, kNoCrossing};
    case StyledLayer::AreaObjects:
      return {Symbol::Area, kReturnPeriod, legend_of("return_period_<kJ>"), 0.4, 0.4, kNoHit};
    case StyledLayer::Stretches:
      return {Symbol::Line, "coalesce(\"mel_kj\", 1e99)", legend_of("energy"), 0.8, 0.8, kNoDesign};
    case StyledLayer::Crossings:
      return {Symbol::Point, "\"energy_kj\"", legend_of("energy"), 1.6, 2.8};
    case StyledLayer::Bins:
      return {Symbol::Line, "coalesce(\"energy_kj_p95\", 1e99)", legend_of("energy"), 1.8, 1.8, kNoCrossing};
    case StyledLayer::Pits:
      return {Symbol::Point, "\"depth_m\"", depth_legend(), 1.2, 2.4};
    case StyledLayer::SourceAreas:
      return {Symbol::Area, "\"slope_deg\"", slope_legend(), 0.2, 0.2};
    case StyledLayer::SourcePoints:
      return {Symbol::Point, "\"slope_deg\"", slope_legend(), 1.2, 1.2};
    case StyledLayer::LineObjects:
      return {Symbol::Line, kReturnPeriod, legend_of("return_period_<kJ>"), 1.8, 1.8, kNoHit};
  }
  throw std::logic_error("a layer without a style");
}

/// "#rrggbb" as QGIS writes the colours of symbols.
std::string colour_text(const std::string& rgb) {
  std::string text;
  for (const int channel : channels_of(rgb)) text += std::to_string(channel) + ",";
  return text + "255";
}

void add_options(const Element& layer, const std::vector<std::pair<const char*, std::string>>& options) {
  const Element map = layer.add("Option");
  map.set("type", "Map");
  for (const auto& [name, value] : options)
    map.add("Option").set("type", "QString").set("name", name).set("value", value);
}

constexpr const char* kDark = "35,35,35,255";  // of outlines: seen on light colours and on a hillshade
constexpr const char* kWhite = "#ffffff";      // of what has no class; no class has it

void add_line(const Element& layer, const std::string& colour, double width) {
  add_options(layer, {{"line_color", colour},
                      {"line_width", text_of(width)},
                      {"line_width_unit", "MM"},
                      {"capstyle", "round"},
                      {"joinstyle", "round"},
                      {"line_style", "solid"}});
}

/// @param rgb  of the inside; empty: an outline alone. White has a wide outline: it is seen on a hillshade, too.
void add_symbol(const Element& symbols, Symbol shape, std::size_t number, const std::string& rgb, double size) {
  constexpr double kRim = 0.4;  // of white on each side [mm]
  static constexpr std::array<const char*, 3> kTypes{"marker", "line", "fill"};
  static constexpr std::array<const char*, 3> kLayers{"SimpleMarker", "SimpleLine", "SimpleFill"};
  const auto kind = static_cast<std::size_t>(shape);
  const Element symbol = symbols.add("symbol");
  symbol.set("type", kTypes[kind]).set("name", std::to_string(number)).set("alpha", "1");
  symbol.set("clip_to_extent", "1").set("force_rhr", "0");
  const auto add_layer = [&] {
    const Element layer = symbol.add("layer");
    layer.set("class", kLayers[kind]).set("enabled", "1").set("locked", "0").set("pass", "0");
    return layer;
  };
  if (shape == Symbol::Line && rgb == kWhite) add_line(add_layer(), kDark, size + 2.0 * kRim);
  if (shape == Symbol::Area && rgb == kWhite) size += kRim;
  const Element layer = add_layer();
  const std::string colour = rgb.empty() ? "0,0,0,0" : colour_text(rgb), width = text_of(size);
  if (shape == Symbol::Line)
    add_line(layer, rgb.empty() ? kDark : colour, size);
  else if (shape == Symbol::Point)
    add_options(layer, {{"name", "circle"},
                        {"color", colour},
                        {"size", width},
                        {"size_unit", "MM"},
                        {"outline_color", kDark},
                        {"outline_style", "solid"},
                        {"outline_width", rgb.empty() ? "0.4" : "0.1"},
                        {"outline_width_unit", "MM"}});
  else
    add_options(layer, {{"color", colour},
                        {"style", "solid"},
                        {"outline_color", kDark},
                        {"outline_style", "solid"},
                        {"outline_width", width},
                        {"outline_width_unit", "MM"}});
}

void add_renderer(const Element& root, const Look& look) {
  constexpr double kMost = 1e100;    // of the last class; QGIS reads no infinite number here
  constexpr double kLongest = 1e98;  // years; below the 1e99 of `kReturnPeriod`
  const Element renderer = root.add("renderer-v2");
  renderer.set("type", "graduatedSymbol").set("attr", look.value).set("graduatedMethod", "GraduatedColor");
  renderer.set("symbollevels", "0").set("enableorderby", "0").set("forceraster", "0");
  const Element ranges = renderer.add("ranges"), symbols = renderer.add("symbols");
  std::vector<LegendClass> classes = classes_of(look.legend, false);
  if (!look.never.empty()) {
    classes.back().limit = kLongest;
    classes.push_back({kMost, look.never, kWhite});
  }
  double low = 0.0;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const bool last = i + 1 == classes.size();
    const double high = last ? kMost : classes[i].limit;
    const double share = static_cast<double>(i) / static_cast<double>(classes.size() - 1);
    ranges.add("range")
        .set("lower", text_of(low))
        .set("upper", text_of(high))
        .set("symbol", std::to_string(i))
        .set("label", classes[i].label)
        .set("render", "true");
    add_symbol(symbols, look.symbol, i, classes[i].colour, look.smallest + share * (look.largest - look.smallest));
    low = high;
  }
}

/// The elements of a style around its renderer, which `add` makes.
template <class Add>
std::string style_with(Symbol symbol, Add add) {
  const QgisDocument document;
  document.root().set("styleCategories", "Symbology");
  add(document.root());
  document.root().add("blendMode", "0");
  document.root().add("featureBlendMode", "0");
  document.root().add("layerGeometryType", std::to_string(static_cast<int>(symbol)));
  return document.text();
}

std::string style_in(const std::string& file) {
  return read_file(file, file, "a style of QGIS", std::size_t{1} << 20U);
}

/// A style with the elements of another one after its own; of those that both have it keeps its own.
std::string joined_styles(const std::string& first, const std::string& second) {
  const QgisDocument document;
  document.root().set("styleCategories", "Symbology");
  const XmlTree one = parsed_xml(first), other = parsed_xml(second);
  const CPLXMLNode* const root = CPLGetXMLNode(one.get(), "=qgis");
  document.root().add_children_of(*root);
  for (const CPLXMLNode* child = CPLGetXMLNode(other.get(), "=qgis")->psChild; child != nullptr; child = child->psNext)
    if (child->eType == CXT_Element && CPLGetXMLNode(root, child->pszValue) == nullptr)
      document.root().add_copy_of(*child);
  return document.text();
}

}  // namespace

std::string style_of(StyledLayer layer) {
  const Look look = look_of(layer);
  return style_with(look.symbol, [&look](const Element& root) { add_renderer(root, look); });
}

std::string outline_style(int dimension) {
  const auto symbol = static_cast<Symbol>(dimension);
  return style_with(symbol, [symbol](const Element& root) {
    const Element renderer = root.add("renderer-v2");
    renderer.set("type", "singleSymbol").set("symbollevels", "0").set("enableorderby", "0").set("forceraster", "0");
    add_symbol(renderer.add("symbols"), symbol, 0, "", symbol == Symbol::Point ? 2.0 : 0.6);
  });
}

void write_styles_beside(const std::filesystem::path& folder) {
  static constexpr std::array<std::pair<const char*, StyledLayer>, 4> kLayers{
      {{"stops", StyledLayer::Stops},
       {"exits", StyledLayer::Exits},
       {"trajectories", StyledLayer::Trajectories},
       {"screens", StyledLayer::Screens}}};
  for (const auto& [name, layer] : kLayers) {
    const std::filesystem::path file = folder / name;
    if (!std::filesystem::exists(file.string() + ".fgb")) continue;
    std::string text = style_of(layer);
    if (std::filesystem::exists(file.string() + ".qml")) text = joined_styles(style_in(file.string() + ".qml"), text);
    write_text(file.string() + ".qml", text);
  }
}

}  // namespace talus::io
