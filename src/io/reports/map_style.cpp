#include "map_style.hpp"

#include <cpl_minixml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>

#include "io/gdal/dataset.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kMostStyle = std::size_t{1} << 20U;
constexpr std::size_t kMostClasses = 64, kMostLabel = 80;

using Xml = std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)>;

std::optional<double> parsed_number(const std::string& text) {
  if (text == "inf") return std::numeric_limits<double>::infinity();
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || std::isnan(value)) return std::nullopt;
  return value;
}

/// "#fca636" or "252,166,54,255".
std::optional<Colour> colour_of(const std::string& text, int opacity) {
  int red = -1, green = -1, blue = -1;
  if (text.size() == 7 && text[0] == '#') {
    unsigned rgb = 0;
    if (const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, rgb, 16);
        error != std::errc{} || end != text.data() + 7)
      return std::nullopt;
    red = static_cast<int>(rgb >> 16U & 255U), green = static_cast<int>(rgb >> 8U & 255U),
    blue = static_cast<int>(rgb & 255U);
  } else if (std::sscanf(text.c_str(), "%3d,%3d,%3d", &red, &green, &blue) != 3) {
    return std::nullopt;
  }
  const auto byte = [](int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); };
  return Colour{byte(red), byte(green), byte(blue), byte(opacity)};
}

void add_class(const CPLXMLNode* item, MapStyle& style) {
  const auto limit = parsed_number(CPLGetXMLValue(item, "value", ""));
  const double opacity = std::clamp(parsed_number(CPLGetXMLValue(item, "alpha", "255")).value_or(255.0), 0.0, 255.0);
  const auto colour = colour_of(CPLGetXMLValue(item, "color", ""), static_cast<int>(opacity));
  if (limit && colour && style.classes.size() < kMostClasses)
    style.classes.push_back({*limit, shortened(CPLGetXMLValue(item, "label", ""), kMostLabel), *colour});
}

}  // namespace

std::optional<std::size_t> MapStyle::class_of(double value) const {
  if (std::isnan(value)) return std::nullopt;
  const auto found = std::ranges::find_if(
      classes, [&](const MapClass& one) { return exact ? value == one.limit : value <= one.limit; });
  if (found == classes.end()) return std::nullopt;
  return static_cast<std::size_t>(found - classes.begin());
}

std::optional<MapStyle> read_map_style(const std::filesystem::path& file) {
  const GdalMessages messages;
  std::string text;
  try {
    text = read_file(file.string(), file.string(), "a style of QGIS", kMostStyle);
  } catch (const InputError&) {
    return std::nullopt;
  }
  const Xml xml(CPLParseXMLString(text.c_str()), CPLDestroyXMLNode);
  const CPLXMLNode* const renderer = CPLGetXMLNode(xml.get(), "=qgis.pipe.rasterrenderer");
  if (renderer == nullptr) return std::nullopt;
  MapStyle style;
  style.band =
      static_cast<int>(std::clamp(parsed_number(CPLGetXMLValue(renderer, "band", "1")).value_or(1.0), 1.0, 1e4));
  const CPLXMLNode* items = CPLGetXMLNode(renderer, "rastershader.colorrampshader");
  if (items == nullptr) {
    items = CPLGetXMLNode(renderer, "colorPalette");
    style.exact = true;
  } else {
    const std::string type = CPLGetXMLValue(items, "colorRampType", "");
    style.exact = type == "EXACT";
    if (!style.exact && type != "DISCRETE") return std::nullopt;
  }
  for (const CPLXMLNode* item = items == nullptr ? nullptr : items->psChild; item != nullptr; item = item->psNext)
    if (item->eType == CXT_Element) add_class(item, style);
  if (style.classes.empty()) return std::nullopt;
  return style;
}

}  // namespace talus::io
