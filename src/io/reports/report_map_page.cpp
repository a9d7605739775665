#include "report_map_page.hpp"

#include <algorithm>
#include <sstream>

#include "io/files/json.hpp"
#include "svg.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

Markup picture(const std::string& id, const std::string& address, const MapScale& scale, bool smooth,
               const Markup& more = {}) {
  Markup image = "<image preserveAspectRatio='none' "_html;
  set_attribute(image, "id", id);
  set_attribute(image, "width", tenth(scale.width));
  set_attribute(image, "height", tenth(scale.height));
  if (!smooth) image += "style='image-rendering:pixelated' opacity='0.8' ";
  image += more;
  set_attribute(image, "href", address);
  return image + "/>\n";
}

/// Values and names of the classes of a map, as the script reads them: [[2,"low"],[3,"medium"]].
std::string named_classes(const MapStyle& style) {
  constexpr double kMost = 1e300;  // JSON has no infinity
  Json pairs = Json::array();
  for (const MapClass& one : style.classes)
    pairs.push_back(Json::array({std::clamp(one.limit, -kMost, kMost), one.label}));
  return pairs.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// What the page's script knows of a map.
Markup data_of(const ReportMap& map) {
  Markup data;
  set_attribute(data, "data-title", map.title);
  set_attribute(data, "data-unit", map.unit);
  if (map.classes_only) {
    set_attribute(data, "data-classes", named_classes(map.style));
  }
  set_attribute(data, "data-values", map.values);
  return data;
}

std::string unit_words(const ReportMap& map) {
  if (map.classes_only || map.unit.empty() || map.unit == "count") return "";
  return map.unit == "1" ? " [%]" : " [" + map.unit + "]";
}

constexpr double kLegendLine = 14.0;  // [px]

/// The title of a legend, in lines that are as long as the legend is wide.
std::vector<std::string> title_lines(const ReportMap& map) {
  constexpr std::size_t kMostLetters = 36;  // bold ones
  std::istringstream words(shortened(map.title + unit_words(map), 90));
  std::vector<std::string> lines;
  for (std::string word; words >> word;)
    if (lines.empty() || lines.back().size() + 1 + word.size() > kMostLetters)
      lines.push_back(word);
    else
      lines.back() += ' ' + word;
  return lines;
}

/// The place of the first class below the title.
double first_class(const ReportMap& map) {
  return 8.0 + kLegendLine * static_cast<double>(std::max<std::size_t>(1, title_lines(map).size()));
}

/// The classes of a map as coloured fields with their labels.
Markup legend(const ReportMap& map, std::size_t number, const MapScale& scale) {
  Svg svg;
  double y = 12.0;
  for (const std::string& line : title_lines(map)) {
    svg.words({{"x", 0}, {"y", y}, {"font-weight", "bold"}}, line);
    y += kLegendLine;
  }
  y = first_class(map);
  for (const MapClass& one : map.style.classes) {
    if (one.colour.opacity == 0 || y > kLowestDrawing - 222.0) continue;
    svg.element("rect", {{"x", 0},
                         {"y", y},
                         {"width", 24},
                         {"height", 14},
                         {"fill", css_colour(one.colour)},
                         {"fill-opacity", "0.8"},
                         {"stroke", "#555"},
                         {"stroke-width", "0.5"}});
    svg.words({{"x", 32}, {"y", y + 11.0}}, one.label);
    y += 18.0;
  }
  Markup group = "<g "_html;
  set_attribute(group, "id", "legend-" + std::to_string(number));
  set_attribute(group, "transform", "translate(" + tenth(scale.width + kLegendGap) + " 0)");
  return group + ">\n" + svg.elements() + "</g>\n";
}

Markup use(const std::string& what, const char* id = nullptr) {
  Markup element = "<use "_html;
  if (id != nullptr) set_attribute(element, "id", id);
  set_attribute(element, "href", "#" + what);
  return element + "/>";
}

std::string box_of(const MapScale& scale, bool with_legend) {
  return "-1 -1 " + tenth(scale.width + 2.0 + (with_legend ? kLegendGap + kLegendWidth : 0.0)) + " " +
         tenth((with_legend ? scale.drawing_height() : scale.height) + 2.0);
}

std::string sentence_of(const ReportMap& map, const MapSheet& sheet) {
  const std::string cells = std::to_string(sheet.window.side);
  std::string text = map.title + unit_words(map) + ", file " + map.file;
  if (sheet.window.side > 1)
    text += "; each pixel shows the " + std::string(map.smallest ? "smallest" : "largest") + " value of its " + cells +
            " x " + cells + " cells";
  return text + ".";
}

}  // namespace

Markup map_store(const MapSheet& sheet, const RunFacts& run, const MapImprint& imprint) {
  const MapScale scale(sheet);
  Markup store = "<svg class='hidden' aria-hidden='true'><defs>\n"_html;
  if (sheet.relief.empty())
    store += "<g id='relief'></g>\n";
  else
    store += picture("relief", sheet.relief, scale, true);
  for (std::size_t i = 0; i < sheet.maps.size(); ++i)
    store += picture("map-" + std::to_string(i), sheet.maps[i].picture, scale, false, data_of(sheet.maps[i])) +
             legend(sheet.maps[i], i, scale);
  return store + outlines(sheet, run, scale) + furniture(sheet, run, imprint, scale) + "</defs></svg>\n";
}

Markup map_viewer(const MapSheet& sheet) {
  if (sheet.maps.empty()) return {};
  const MapScale scale(sheet);
  double lowest = 0.0;  // end of the longest legend
  for (const ReportMap& map : sheet.maps)
    lowest = std::max(lowest, first_class(map) + 18.0 * static_cast<double>(map.style.classes.size()));
  Markup html =
      "<div class='screen'><h3>Compare two maps</h3>\n<p>Move the slider: left of it is the first map, right of it the "
      "second. Click on the map: the table shows the values of the cell there, of every map.</p>\n<p><label>Left "
      "<select id='choose-a'></select></label> <label>Right <select id='choose-b'></select></label></p>\n<svg "
      "id='viewer' style='cursor:crosshair' "_html;
  set_attribute(html, "viewBox", box_of(scale, true));
  set_attribute(html, "width", tenth(scale.width + kLegendGap + kLegendWidth));
  set_attribute(html, "data-columns", std::to_string(sheet.window.width()));
  set_attribute(html, "data-rows", std::to_string(sheet.window.height()));
  set_attribute(html, "data-width", tenth(scale.width));
  set_attribute(html, "data-height", tenth(scale.height));
  set_attribute(html, "data-west", with_decimals(sheet.west, 3));
  set_attribute(html, "data-north", with_decimals(sheet.north, 3));
  set_attribute(html, "data-pixel-x", with_digits(sheet.pixel_x, 12));
  set_attribute(html, "data-pixel-y", with_digits(sheet.pixel_y, 12));
  html += "><clipPath id='left'><rect id='left-part' y='-1' x='-1' width='0' ";
  set_attribute(html, "height", tenth(scale.height + 2.0));
  html += "/></clipPath><clipPath id='right'><rect id='right-part' y='-1' width='0' ";
  set_attribute(html, "height", tenth(scale.height + 2.0));
  html += "/></clipPath>\n"_html + use("relief") + "<g clip-path='url(#left)'>" + use("map-0", "view-a") +
          "</g><g clip-path='url(#right)'>" + use("map-0", "view-b") + "</g>" + use("outlines") + use("furniture");
  html += "<line id='edge' y1='0' stroke='#000' stroke-width='2' ";
  set_attribute(html, "y2", tenth(scale.height));
  html +=
      "/><circle id='mark' r='6' fill='none' stroke='#000' stroke-width='2' visibility='hidden'/></svg>\n<p><input "
      "id='slider' type='range' min='0' max='1000' value='500' aria-label='place of the slider' ";
  set_attribute(html, "style", "margin:0;width:" + tenth(scale.width) + "px;max-width:100%");
  html += "></p>\n<svg ";
  set_attribute(html, "viewBox",
                tenth(scale.width + kLegendGap) + " 0 " + tenth(2.0 * kLegendWidth + 60.0) + " " + tenth(lowest));
  set_attribute(html, "width", tenth(2.0 * kLegendWidth + 60.0));
  html += ">"_html + use("legend-0", "legend-a") + "<g transform='translate(260 0)'>" + use("legend-0", "legend-b") +
          "</g></svg>";
  return html +
         "\n<p id='place'>No place is chosen yet.</p>\n<table id='values'></table>\n<p class='note'>Values are "
         "rounded to three digits; - stands for no value.</p></div>\n";
}

Markup map_figures(const MapSheet& sheet, const MapImprint& imprint) {
  constexpr double kTwoOnAPage = 1.25;  // width of a drawing by its height from which two fit on a printed page
  const MapScale scale(sheet);
  const bool low = scale.width + kLegendGap + kLegendWidth > kTwoOnAPage * scale.drawing_height();
  Markup html;
  for (std::size_t i = 0; i < sheet.maps.size(); ++i) {
    if (!sheet.maps[i].in_print) continue;
    html += low ? "<figure class='map low'><svg "_html : "<figure class='map'><svg "_html;
    set_attribute(html, "viewBox", box_of(scale, true));
    set_attribute(html, "width", tenth(scale.width + kLegendGap + kLegendWidth));
    html += ">"_html + use("relief") + use("map-" + std::to_string(i)) + use("outlines") + use("furniture") +
            use("legend-" + std::to_string(i)) + "</svg>\n<figcaption>" + sentence_of(sheet.maps[i], sheet);
    if (!imprint.attribution.empty()) html += " "_html + imprint.attribution;
    html += "</figcaption></figure>\n";
  }
  return html;
}

}  // namespace talus::io
