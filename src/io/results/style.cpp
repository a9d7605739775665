#include "talus/io/results/style.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>
#include <vector>

#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kColours = 6;
using Palette = std::array<std::string_view, kColours>;

// Six steps of matplotlib's plasma, viridis and cividis (CC0), from light to dark: of even steps in lightness, also for
// the colour-blind.
constexpr Palette kPlasma{"#f0f921", "#fca636", "#e16462", "#b12a90", "#6a00a8", "#0d0887"};
constexpr Palette kViridis{"#fde725", "#7ad151", "#22a884", "#2a788e", "#414487", "#440154"};
constexpr Palette kPlasmaDark{"#0d0887", "#6a00a8", "#b12a90", "#e16462", "#fca636", "#f0f921"};  // small is grave
// The classes of the Swiss matrix: yellow and white, yellow, blue, red; further ones, should there be any, darker.
constexpr Palette kClasses{"#fff9c4", "#ffd600", "#2979ff", "#d50000", "#7f0000", "#3e0000"};
constexpr Palette kCividis{"#ffea46", "#cbba69", "#958f78", "#666970", "#31446b", "#00204d"};

/// Classes up to each limit, and one above the last.
struct Legend {
  std::vector<double> limits;  // in the unit of the file
  double factor;               // to the unit of the labels
  std::string unit;            // of the labels; empty for none
  const Palette* palette;
  std::string_view band = {};  // shown; the first where empty
};

Legend legend_of(const Map& map) {
  const std::string& unit = map.bands.front().unit;
  if (unit == "1/year") return {{1e-4, 1e-3, 1e-2, 1e-1, 1.0}, 1.0, unit, &kPlasma};
  if (unit == "years") return {{10, 30, 100, 300, 1000}, 1.0, unit, &kPlasmaDark};
  if (unit == "class") return {{1, 2, 3, 4, 5}, 1.0, "", &kClasses};
  if (map.kind == Map::Kind::Probability) return {{1e-4, 1e-3, 1e-2, 1e-1, 1.0}, 100.0, "%", &kPlasma};
  if (map.kind == Map::Kind::Count) {
    if (map.name == "sources") return {{1, 3, 10, 30, 100}, 1.0, "", &kCividis};
    return {{1, 10, 100, 1000, 10000}, 1.0, "", &kCividis};
  }
  if (unit == "kJ") return {{30, 100, 300, 1000, 3000}, 1.0, unit, &kPlasma, "P95"};
  if (unit == "m/s") return {{5, 10, 15, 20, 30}, 1.0, unit, &kViridis, "P95"};
  return {{0.5, 1, 2, 4, 8}, 1.0, unit, &kViridis, "P95"};
}

std::size_t band_of(const Map& map, std::string_view name) {
  const auto found =
      std::find_if(map.bands.begin(), map.bands.end(), [name](const Map::Band& b) { return b.name == name; });
  return found == map.bands.end() ? 0 : static_cast<std::size_t>(found - map.bands.begin());
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

std::string item(std::string_view value, std::string_view label, std::string_view colour, int alpha) {
  std::string line = "          <item value=\"";
  line.append(value).append("\" label=\"").append(escaped(label)).append("\" color=\"").append(colour);
  return line.append("\" alpha=\"").append(std::to_string(alpha)).append("\"/>\n");
}

/// A limit in a label: never with an exponent.
std::string plain(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed).ptr;
  return {digits.begin(), end};
}

/// The classes of a legend: an item is a class's upper limit, which belongs to it.
std::string items_of(const Map& map, const Legend& legend) {
  if (!map.classes.empty()) {
    std::string named = item("0", map.classes[0], "#ffffff", 0);
    for (std::size_t i = 1; i < map.classes.size(); ++i)
      named += item(std::to_string(i), map.classes[i], (*legend.palette)[std::min(i, kColours) - 1], 255);
    return named;
  }
  const std::string unit = legend.unit.empty() ? "" : " " + legend.unit;
  const bool to_one = map.kind == Map::Kind::Probability;  // nothing is above 100 %
  const std::size_t classes = legend.limits.size() + (to_one ? 0 : 1);
  std::string items = item("0", "0" + unit, "#ffffff", 0);  // nothing is there: not drawn
  std::string below;
  for (std::size_t i = 0; i < classes; ++i) {
    const std::string_view colour = (*legend.palette)[i + kColours - classes];
    if (i == legend.limits.size()) {
      items += item("inf", "above " + below + unit, colour, 255);
      break;
    }
    const std::string limit = plain(legend.limits[i] * legend.factor);
    const std::string label = below.empty() ? "up to " + limit : below + " to " + limit;
    items += item(i + 1 == classes ? "inf" : text_of(legend.limits[i]), label + unit, colour, 255);
    below = limit;
  }
  return items;
}

}  // namespace

std::string style_of(const Map& map) {
  const Legend legend = legend_of(map);
  const std::string band = std::to_string(band_of(map, legend.band) + 1);
  const std::string maximum = text_of(legend.limits.back());
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
         "<qgis version=\"3.22.0\" styleCategories=\"Symbology\">\n"
         "  <pipe>\n"
         "    <rasterrenderer type=\"singlebandpseudocolor\" band=\"" +
         band +
         "\" opacity=\"0.8\" alphaBand=\"-1\" "
         "nodataColor=\"\" classificationMin=\"0\" classificationMax=\"" +
         maximum +
         "\">\n"
         "      <rasterTransparency/>\n"
         "      <minMaxOrigin>\n"
         "        <limits>None</limits>\n"
         "        <extent>WholeRaster</extent>\n"
         "        <statAccuracy>Estimated</statAccuracy>\n"
         "      </minMaxOrigin>\n"
         "      <rastershader>\n"
         "        <colorrampshader colorRampType=\"DISCRETE\" classificationMode=\"1\" clip=\"0\" minimumValue=\"0\" "
         "maximumValue=\"" +
         maximum + "\">\n" + items_of(map, legend) +
         "        </colorrampshader>\n"
         "      </rastershader>\n"
         "    </rasterrenderer>\n"
         "    <brightnesscontrast brightness=\"0\" contrast=\"0\"/>\n"
         "    <huesaturation saturation=\"0\" grayscaleMode=\"0\" colorizeOn=\"0\"/>\n"
         "    <rasterresampler maxOversampling=\"2\"/>\n"
         "  </pipe>\n"
         "  <blendMode>0</blendMode>\n"
         "</qgis>\n";
}

void write_style(const std::filesystem::path& folder, const Map& map) {
  write_text(folder / (map.name + ".qml"), style_of(map));
}

}  // namespace talus::io
