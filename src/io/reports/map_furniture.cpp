#include "map_furniture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "svg.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr double kWidest = 700.0, kTallest = 700.0;  // of a map in a drawing [px]
constexpr const char* kSourceColour = "#111111";
constexpr const char* kScreenColour = "#c2185b";
constexpr const char* kObjectColour = "#00695c";
constexpr const char* kBarrierColour = "#e65100";

/// The rim of the marked pixels as a path, in pixels. Empty if it is too ragged to be one.
std::string rim_of(const std::vector<std::uint8_t>& marks, int width) {
  constexpr std::size_t kMostPath = 400'000;
  const int height = width > 0 ? static_cast<int>(marks.size()) / width : 0;
  const auto marked = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < width && y < height && marks[std::size_t(y) * width + x] != 0;
  };
  std::string path;
  for (const bool across : {true, false}) {
    const int lines = across ? height : width, length = across ? width : height;
    for (int line = 0; line <= lines && path.size() < kMostPath; ++line) {
      int start = -1;
      for (int at = 0; at <= length; ++at) {
        const bool edge = at < length && (across ? marked(at, line) != marked(at, line - 1)
                                                 : marked(line, at) != marked(line - 1, at));
        if (edge && start < 0) start = at;
        if (edge || start < 0) continue;
        const auto place = [&](int along, int aside) { return std::to_string(along) + " " + std::to_string(aside); };
        path += "M" + (across ? place(start, line) : place(line, start)) + (across ? "H" : "V") + std::to_string(at);
        start = -1;
      }
    }
  }
  return path.size() < kMostPath ? path : "";
}

std::string points_of(const std::vector<Eigen::Vector2d>& places, const MapScale& scale) {
  std::string points;
  for (const Eigen::Vector2d& place : places)
    points += (points.empty() ? "" : " ") + tenth(scale.x(place.x())) + "," + tenth(scale.y(place.y()));
  return points;
}

/// Marked pixels as squares that are seen also where the pixels are small.
Markup squares_of(const std::vector<std::uint8_t>& marks, const MapClass& look, const MapSheet& sheet,
                  const MapScale& scale) {
  constexpr double kLeastSide = 4.0;  // [px]
  const double across = scale.per_metre * sheet.pixel_x, down = scale.per_metre * sheet.pixel_y;
  const double wide = std::max(across, kLeastSide), high = std::max(down, kLeastSide);
  const auto width = static_cast<std::size_t>(sheet.window.width());
  std::string path;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i] != 0)
      path += "M" + tenth((static_cast<double>(i % width) + 0.5) * across - 0.5 * wide) + " " +
              tenth((static_cast<double>(i / width) + 0.5) * down - 0.5 * high) + "h" + tenth(wide) + "v" +
              tenth(high) + "h-" + tenth(wide) + "z";
  if (path.empty()) return {};
  Markup squares = "<path id='cut-short' stroke='#fff' stroke-width='0.4' "_html;
  set_attribute(squares, "fill", css_colour(look.colour));
  set_attribute(squares, "d", path);
  return squares + "/>\n";
}

/// A rectangle in pixels.
struct Box {
  double left, top, right, low;
};

Box box_around(const std::vector<Eigen::Vector2d>& places, const MapScale& scale) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  Box box{kNever, kNever, -kNever, -kNever};
  for (const Eigen::Vector2d& place : places) {
    const double x = scale.x(place.x()), y = scale.y(place.y());
    box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x), std::max(box.low, y)};
  }
  return box;
}

/// Writes names on the map, each beside what it names, where it is within the map and covers neither a kept box nor an
/// earlier name, and no line where that can be had. A name without such a place covers a kept box, and a name without
/// any place beside what it names stands as near as there is room, with a line that leads to it.
class Names {
 public:
  Names(Svg& svg, const MapScale& scale) : svg_(svg), scale_(scale) {}

  void keep_free(const Box& box) { kept_.push_back(box); }

  void keep_free(const std::vector<Eigen::Vector2d>& line) {
    constexpr double kStep = 4.0;  // between points of a line that must not be covered [px]
    for (const Eigen::Vector2d& place : points_on(line, kStep)) on_lines_.push_back(place);
  }

  /// @param line  the name may stand anywhere beside it: its middle may be far from that of its own box
  void put_at_line(const std::string& name, const std::vector<Eigen::Vector2d>& line, const char* colour) {
    constexpr double kStep = 25.0;  // between places that are tried [px]
    std::vector<Box> boxes;
    for (const Eigen::Vector2d& place : line) boxes.push_back(box_around({place}, scale_));
    for (const Eigen::Vector2d& at : points_on(line, kStep)) boxes.push_back({at.x(), at.y(), at.x(), at.y()});
    put(name, boxes, colour);
  }

  /// @param beside  the name may stand beside any of them
  void put(const std::string& name, const std::vector<Box>& beside, const char* colour) {
    const std::string text = shortened(name, 32);
    for (const Covers covers : {Covers::Nothing, Covers::Lines, Covers::Kept})
      for (const Box& of : beside)
        for (const Box& box : boxes_beside(of, text))
          if (is_free(box, covers)) return write(text, box, colour);
    for (const Box& of : beside)
      if (is_on_map(of)) return put_near(text, of, colour);
  }

 private:
  static constexpr double kLine = 13.0;  // height of a name [px]
  enum class Covers { Nothing, Lines, Kept };

  bool is_on_map(const Box& box) const {
    return box.right >= 0.0 && box.low >= 0.0 && box.left <= scale_.width && box.top <= scale_.height;
  }

  /// Points of the parts of a line that are on the map [px].
  std::vector<Eigen::Vector2d> points_on(const std::vector<Eigen::Vector2d>& line, double distance) const {
    std::vector<Eigen::Vector2d> points;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d from(scale_.x(line[i].x()), scale_.y(line[i].y())),
          way = Eigen::Vector2d(scale_.x(line[i + 1].x()), scale_.y(line[i + 1].y())) - from;
      const auto [first, last] = on_map(from, way);
      if (first > last) continue;
      const double steps = std::ceil((last - first) * way.norm() / distance);
      for (double step = 0.0; step <= steps; ++step)
        points.emplace_back(from + (first + step / std::max(1.0, steps) * (last - first)) * way);
    }
    return points;
  }

  /// Writes a name in the nearest room on rings around what it names.
  void put_near(const std::string& text, const Box& of, const char* colour) {
    const Eigen::Vector2d middle(std::clamp(0.5 * (of.left + of.right), 0.0, scale_.width),
                                 std::clamp(0.5 * (of.top + of.low), 0.0, scale_.height));
    const double width = width_of(text);
    for (double radius = 20.0; radius < scale_.width + scale_.height; radius += 10.0)
      for (int turn = 0; turn < 32; ++turn) {
        const double angle = turn * std::numbers::pi / 16.0;
        const Eigen::Vector2d at = middle + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        const Box box{at.x() - 0.5 * width, at.y() - 0.5 * kLine, at.x() + 0.5 * width, at.y() + 0.5 * kLine};
        if (!is_free(box, Covers::Kept)) continue;
        svg_.element("line", {{"x1", middle.x()},
                              {"y1", middle.y()},
                              {"x2", std::clamp(middle.x(), box.left, box.right)},
                              {"y2", std::clamp(middle.y(), box.top, box.low)},
                              {"stroke", colour}});
        return write(text, box, colour);
      }
  }

  /// Shares of a way between which it is on the map: a vertex may lie far off. The first is larger if it never is.
  std::pair<double, double> on_map(const Eigen::Vector2d& from, const Eigen::Vector2d& way) const {
    double first = 0.0, last = 1.0;
    const double side[] = {scale_.width, scale_.height};
    for (int axis = 0; axis < 2; ++axis) {
      if (way[axis] == 0.0) {
        if (from[axis] < 0.0 || from[axis] > side[axis]) last = -1.0;
        continue;
      }
      const auto [in, out] = std::minmax({-from[axis] / way[axis], (side[axis] - from[axis]) / way[axis]});
      first = std::max(first, in);
      last = std::min(last, out);
    }
    return {first, last};
  }

  static double width_of(const std::string& text) {
    constexpr double kLetter = 6.8;  // of bold letters, generous [px]
    return kLetter * static_cast<double>(text.size());
  }

  std::array<Box, 8> boxes_beside(const Box& of, const std::string& text) const {
    constexpr double kGap = 5.0;  // [px]
    const double width = width_of(text), beside = 0.5 * (of.top + of.low + kLine);
    const double right = of.right + kGap, left = of.left - kGap - width,
                 centred = std::min(0.5 * (of.left + of.right - width), scale_.width - width);  // or at the map's rim
    const double above = of.top - 2.0, below = of.low + kLine + 2.0;
    const auto box = [&](double x, double y) { return Box{x, y - kLine, x + width, y}; };
    return {box(right, beside), box(left, beside), box(centred, above), box(centred, below),
            box(right, above),  box(right, below), box(left, above),    box(left, below)};
  }

  bool is_free(const Box& box, Covers covers) const {
    if (!(box.left >= 0.0 && box.top >= 0.0 && box.right <= scale_.width && box.low <= scale_.height)) return false;
    const auto overlaps = [&](const Box& other) {
      return box.left < other.right && other.left < box.right && box.top < other.low && other.top < box.low;
    };
    const auto contains = [&](const Eigen::Vector2d& at) {
      return box.left <= at.x() && at.x() <= box.right && box.top <= at.y() && at.y() <= box.low;
    };
    return std::ranges::none_of(names_, overlaps) &&
           (covers >= Covers::Kept || std::ranges::none_of(kept_, overlaps)) &&
           (covers >= Covers::Lines || std::ranges::none_of(on_lines_, contains));
  }

  void write(const std::string& text, const Box& box, const char* colour) {
    names_.push_back(box);
    svg_.words({{"x", box.left},
                {"y", box.low - 2.0},
                {"fill", colour},
                {"font-weight", "bold"},
                {"stroke", "#fff"},
                {"stroke-width", 3},
                {"paint-order", "stroke"}},
               text);
  }

  Svg& svg_;
  const MapScale& scale_;
  std::vector<Box> kept_, names_;
  std::vector<Eigen::Vector2d> on_lines_;  // points of lines [px]
};

void draw_lines(Svg& svg, const Screen& screen, const char* colour, const char* dashes, const MapScale& scale) {
  for (const auto& line : screen.lines)
    svg.element("polyline", {{"points", points_of(line, scale)},
                             {"fill", "none"},
                             {"stroke", colour},
                             {"stroke-width", 2},
                             {"stroke-dasharray", dashes}});
}

void draw_objects(Svg& svg, const Outlines& objects, const MapScale& scale) {
  for (const Outline& object : objects.list) {
    if (object.places.size() == 1) {
      svg.element("circle", {{"cx", scale.x(object.places[0].x())},
                             {"cy", scale.y(object.places[0].y())},
                             {"r", 4},
                             {"fill", "none"},
                             {"stroke", kObjectColour},
                             {"stroke-width", 2}});
      continue;
    }
    svg.element(object.closed ? "polygon" : "polyline", {{"points", points_of(object.places, scale)},
                                                         {"fill", "none"},
                                                         {"stroke", kObjectColour},
                                                         {"stroke-width", 2}});
  }
}

/// Whether a screen is an object, too, as a road of the same name: its name is written once.
bool is_object(const std::string& name, const std::vector<Eigen::Vector2d>& line, const Outlines& objects,
               const MapScale& scale) {
  constexpr double kSame = 5.0;  // [px]
  const auto is_at = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a - b).norm() * scale.per_metre < kSame;
  };
  return std::ranges::any_of(objects.list, [&](const Outline& object) {
    const auto& places = object.places;
    if (object.name != name || object.closed || places.size() < 2 || line.empty()) return false;
    return (is_at(line.front(), places.front()) && is_at(line.back(), places.back())) ||
           (is_at(line.front(), places.back()) && is_at(line.back(), places.front()));
  });
}

void write_names(Svg& svg, const RunFacts& run, const Outlines& objects, const MapScale& scale) {
  constexpr std::size_t kMostNames = 40;
  const bool few = objects.list.size() <= kMostNames;
  const auto is_line = [](const Outline& object) { return !object.closed && object.places.size() > 1; };
  Names names(svg, scale);
  for (const Screen& screen : run.screens)
    for (const auto& line : screen.lines) names.keep_free(line);
  for (const StandingBarrier& barrier : run.barriers)
    for (const auto& line : barrier.line.lines) names.keep_free(line);
  for (const Outline& object : objects.list)
    if (is_line(object))
      names.keep_free(object.places);
    else if (few)
      names.keep_free(box_around(object.places, scale));
  for (const Outline& object : objects.list)
    if (few && is_line(object))
      names.put_at_line(object.name, object.places, kObjectColour);
    else if (few)
      names.put(object.name, {box_around(object.places, scale)}, kObjectColour);
  for (const Screen& screen : run.screens)
    for (const auto& line : screen.lines)
      if (!few || !is_object(screen.id, line, objects, scale)) names.put_at_line(screen.id, line, kScreenColour);
  for (const StandingBarrier& barrier : run.barriers)
    for (const auto& line : barrier.line.lines) names.put_at_line(barrier.line.id, line, kBarrierColour);
}

/// Ticks with coordinates at the lower and the left rim.
void draw_coordinates(Svg& svg, const MapScale& scale) {
  const double east = scale.west + scale.width / scale.per_metre, south = scale.north - scale.height / scale.per_metre;
  for (const double place : ticks(scale.west, east, 6)) {
    const double x = scale.x(place);
    svg.element("line", {{"x1", x}, {"x2", x}, {"y1", scale.height}, {"y2", scale.height - 7.0}, {"stroke", "#000"}});
    if (x > 30.0 && x < scale.width - 30.0)
      svg.words({{"x", x},
                 {"y", scale.height - 10.0},
                 {"text-anchor", "middle"},
                 {"stroke", "#fff"},
                 {"stroke-width", 3},
                 {"paint-order", "stroke"}},
                with_decimals(place, 0));
  }
  for (const double place : ticks(south, scale.north, 6)) {
    const double y = scale.y(place);
    svg.element("line", {{"x1", 0}, {"x2", 7}, {"y1", y}, {"y2", y}, {"stroke", "#000"}});
    if (y > 14.0 && y < scale.height - 26.0)
      svg.words({{"x", 10}, {"y", y + 4.0}, {"stroke", "#fff"}, {"stroke-width", 3}, {"paint-order", "stroke"}},
                with_decimals(place, 0));
  }
  svg.element(
      "rect",
      {{"x", 0}, {"y", 0}, {"width", scale.width}, {"height", scale.height}, {"fill", "none"}, {"stroke", "#000"}});
}

/// The largest length of 1, 2 or 5 times a power of ten that is at most `most` [m].
double round_length(double most) {
  const double unit = std::pow(10.0, std::floor(std::log10(most)));
  return unit * (most >= 5.0 * unit ? 5.0 : most >= 2.0 * unit ? 2.0 : 1.0);
}

void draw_scale_bar(Svg& svg, double y, const MapScale& scale) {
  const double metres = round_length(170.0 / scale.per_metre), length = metres * scale.per_metre;
  for (int part = 0; part < 2; ++part)
    svg.element("rect", {{"x", 0.5 * length * part},
                         {"y", y},
                         {"width", 0.5 * length},
                         {"height", 6},
                         {"fill", part == 0 ? "#000" : "#fff"},
                         {"stroke", "#000"}});
  const bool far = metres >= 2000.0;
  svg.words({{"x", 0}, {"y", y + 19.0}}, "0");
  svg.words({{"x", length}, {"y", y + 19.0}, {"text-anchor", "middle"}},
            text_of(far ? 1e-3 * metres : metres) + (far ? " km" : " m"));
}

void draw_north(Svg& svg, double x, double y) {
  svg.element("polygon", {{"points", tenth(x) + "," + tenth(y) + " " + tenth(x + 8) + "," + tenth(y + 26) + " " +
                                         tenth(x) + "," + tenth(y + 20) + " " + tenth(x - 8) + "," + tenth(y + 26)}});
  svg.words({{"x", x}, {"y", y - 4.0}, {"text-anchor", "middle"}, {"font-weight", "bold"}}, "N");
}

}  // namespace

MapScale::MapScale(const MapSheet& sheet)
    : per_metre(std::min(kWidest / (sheet.window.width() * sheet.pixel_x),
                         kTallest / (sheet.window.height() * sheet.pixel_y))),
      width(per_metre * sheet.window.width() * sheet.pixel_x),
      height(per_metre * sheet.window.height() * sheet.pixel_y),
      west(sheet.west),
      north(sheet.north) {}

double MapScale::drawing_height() const {
  return std::max(height, kLowestDrawing);
}

std::string css_colour(const Colour& colour) {
  return "rgb(" + std::to_string(colour.red) + "," + std::to_string(colour.green) + "," + std::to_string(colour.blue) +
         ")";
}

std::string tenth(double value) {
  return with_decimals(value, 1);
}

Markup& set_attribute(Markup& to, const char* name, const std::string& value) {
  return ((to += std::string_view(name)) += "=\"").add_value(value) += "\" ";
}

Markup furniture(const MapSheet& sheet, const RunFacts& run, const MapImprint& imprint, const MapScale& scale) {
  Svg svg;
  double y = scale.drawing_height() - 132.0;
  const auto key = [&](const std::string& colour, const char* dashes, const std::string& text, int width = 2) {
    svg.element("line", {{"x1", 0},
                         {"x2", 22},
                         {"y1", y - 4.0},
                         {"y2", y - 4.0},
                         {"stroke", colour},
                         {"stroke-width", width},
                         {"stroke-dasharray", dashes}});
    svg.words({{"x", 28}, {"y", y}}, text);
    y -= 16.0;
  };
  if (!sheet.cut_short.empty()) key(css_colour(sheet.cut.colour), "none", sheet.cut.label, 6);
  if (!sheet.objects.list.empty()) key(kObjectColour, "none", "objects");
  if (!run.screens.empty()) key(kScreenColour, "7 3", "screens");
  if (!run.barriers.empty()) key(kBarrierColour, "none", "barriers of the run");
  if (!sheet.sources.empty()) key(kSourceColour, "none", "source cells");
  y = scale.drawing_height() - 116.0;
  draw_scale_bar(svg, y, scale);
  draw_north(svg, kLegendWidth - 26.0, y - 20.0);
  const std::string side = with_digits(sheet.pixel_x, 4), cells = std::to_string(sheet.window.side);
  y += 38.0;
  for (const std::string& line :
       {shortened(imprint.crs, 36), std::string("grid north; coordinates in m"), "run.json of " + imprint.date,
        sheet.window.side == 1 ? "1 pixel = 1 cell of " + side + " m"
                               : "1 pixel = " + cells + " x " + cells + " cells, " + side + " m",
        shortened(imprint.attribution, 36)}) {
    svg.words({{"x", 0}, {"y", y}}, line);
    y += 16.0;
  }
  Markup group = "<g id='furniture' "_html;
  set_attribute(group, "transform", "translate(" + tenth(scale.width + kLegendGap) + " 0)");
  return group + ">\n" + svg.elements() + "</g>\n";
}

Markup outlines(const MapSheet& sheet, const RunFacts& run, const MapScale& scale) {
  Markup group = "<clipPath id='frame'><rect "_html;
  set_attribute(group, "width", tenth(scale.width));
  set_attribute(group, "height", tenth(scale.height));
  group += "/></clipPath>\n<g id='outlines' clip-path='url(#frame)'>\n";
  if (const std::string rim = rim_of(sheet.sources, sheet.window.width()); !rim.empty()) {
    group += "<path fill='none' stroke-width='1.2' vector-effect='non-scaling-stroke' ";
    set_attribute(group, "stroke", kSourceColour);
    set_attribute(group, "transform",
                  "scale(" + with_digits(scale.per_metre * sheet.pixel_x, 8) + " " +
                      with_digits(scale.per_metre * sheet.pixel_y, 8) + ")");
    set_attribute(group, "d", rim);
    group += "/>\n";
  }
  group += squares_of(sheet.cut_short, sheet.cut, sheet, scale);
  Svg svg;
  draw_objects(svg, sheet.objects, scale);
  for (const Screen& screen : run.screens) draw_lines(svg, screen, kScreenColour, "7 3", scale);
  for (const StandingBarrier& barrier : run.barriers) draw_lines(svg, barrier.line, kBarrierColour, "none", scale);
  write_names(svg, run, sheet.objects, scale);
  draw_coordinates(svg, scale);
  return group + svg.elements() + "</g>\n";
}

}  // namespace talus::io
