#include "report_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "io/gdal/csv_table.hpp"
#include "report_facts.hpp"
#include "svg.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/products/energy_words.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

constexpr Bounds kAny{"value", "1", "of an object", -1e300, 1e300};
constexpr std::size_t kMostObjects = 100, kMostCurves = 8, kMostThresholds = 6;
constexpr const char* kYears = "return_period_";
// Of ColorBrewer's Dark2, safe for the colour-blind beside the dashes.
constexpr std::array<const char*, kMostCurves> kColours{"#1b9e77", "#d95f02", "#7570b3", "#e7298a",
                                                        "#66a61e", "#e6ab02", "#a6761d", "#666666"};

void read_thresholds(const CsvTable& table, ObjectsPart& part) {
  for (const std::string& column : table.columns()) {
    if (!column.starts_with(kYears) || part.thresholds.size() == kMostThresholds) continue;
    const std::string energy = column.substr(std::string(kYears).size());
    if (number_of_cell(energy)) part.thresholds.push_back(energy);
  }
}

void read_curves(const fs::path& file, ObjectsPart& part) {
  std::error_code none;
  if (!fs::exists(file, none)) return;
  if (const std::string fault = too_large_for_page(file); !fault.empty()) {
    part.note = fault + ": the curves are not drawn.";
    return;
  }
  const std::string energies = part.with_rotation ? "total_energy_kj" : "energy_kj";
  const auto add_point = [&part, &energies](const CsvTable& table, const CsvTable::Row& row) {
    for (ObjectsPart::Object& object : part.objects) {
      if (object.name != table.text(row, "object")) continue;
      const auto energy = table.number(row, energies, kAny), frequency = table.number(row, "frequency", kAny);
      if (energy && frequency && *energy > 0.0 && *frequency > 0.0) object.curve.push_back({*energy, *frequency});
    }
  };
  CsvTable(file.string(), {"object", energies, "frequency", "lower", "upper", "return_period"},
           {"object", energies, "frequency"}, add_point);
}

double place_of(double value, double low, double high, double from, double length) {
  return from + length * (std::log10(value) - low) / (high - low);
}

/// How often each energy is exceeded, for the objects that are hit most often. Both scales are logarithmic.
Markup curves_drawing(const ObjectsPart& part) {
  std::vector<const ObjectsPart::Object*> drawn;
  double least = 1e30, most = 0.0, weakest = 1e30, strongest = 0.0;
  for (const ObjectsPart::Object& object : part.objects) {
    if (object.curve.empty() || drawn.size() == kMostCurves) continue;
    drawn.push_back(&object);
    for (const auto& [energy, frequency] : object.curve) {
      weakest = std::min(weakest, energy), strongest = std::max(strongest, energy);
      least = std::min(least, frequency), most = std::max(most, frequency);
    }
  }
  if (drawn.empty()) return {};
  const double left = std::floor(std::log10(weakest)), right = std::max(left + 1.0, std::ceil(std::log10(strongest)));
  const double low = std::floor(std::log10(least)), high = std::max(low + 1.0, std::ceil(std::log10(most)));
  Svg svg('\'', "");
  for (double tenfold = left; tenfold <= right; ++tenfold) {
    const double x = place_of(std::pow(10.0, tenfold), left, right, 70.0, 400.0);
    svg.element("line", {{"x1", x}, {"x2", x}, {"y1", 20}, {"y2", 260}, {"stroke", "#ddd"}});
    svg.words({{"x", x}, {"y", 275}, {"text-anchor", "middle"}}, with_digits(std::pow(10.0, tenfold), 3));
  }
  for (double tenfold = low; tenfold <= high; ++tenfold) {
    const double y = place_of(std::pow(10.0, tenfold), low, high, 260.0, -240.0);
    svg.element("line", {{"x1", 70}, {"x2", 470}, {"y1", y}, {"y2", y}, {"stroke", "#ddd"}});
    svg.words({{"x", 64}, {"y", y + 4.0}, {"text-anchor", "end"}}, with_digits(std::pow(10.0, tenfold), 3));
  }
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    std::string points;
    for (const auto& [energy, frequency] : drawn[i]->curve)
      points += with_decimals(place_of(energy, left, right, 70.0, 400.0), 1) + "," +
                with_decimals(place_of(frequency, low, high, 260.0, -240.0), 1) + " ";
    const std::string dashes = i % 2 == 0 ? "none" : "6 3";
    const double y = 30.0 + 18.0 * static_cast<double>(i);
    svg.element("polyline", {{"points", points},
                             {"fill", "none"},
                             {"stroke", kColours[i]},
                             {"stroke-width", 2},
                             {"stroke-linejoin", "round"},
                             {"stroke-linecap", "round"},
                             {"stroke-dasharray", dashes}});
    if (drawn[i]->curve.size() == 1)
      svg.element("circle", {{"cx", place_of(drawn[i]->curve[0].energy, left, right, 70.0, 400.0)},
                             {"cy", place_of(drawn[i]->curve[0].frequency, low, high, 260.0, -240.0)},
                             {"r", 4},
                             {"fill", kColours[i]}});
    svg.element("line", {{"x1", 490},
                         {"x2", 516},
                         {"y1", y},
                         {"y2", y},
                         {"stroke", kColours[i]},
                         {"stroke-width", 2},
                         {"stroke-dasharray", dashes}});
    svg.words({{"x", 522}, {"y", y + 4.0}}, shortened(drawn[i]->name, 32));
  }
  svg.words({{"x", 270}, {"y", 292}, {"text-anchor", "middle"}}, energy_words(part.with_rotation).name + " [kJ]");
  svg.words({{"x", 4}, {"y", 12}}, "exceeded how often [1/year]");
  return svg.drawing({{"width", 720}, {"height", 298}, {"viewBox", "0 0 720 298"}});
}

Markup not_assessed_row(const std::string& name, const ObjectsPart& part, bool classes) {
  return "<tr><td>"_html + name + "</td><td colspan='" + std::to_string(part.thresholds.size() + (classes ? 4 : 3)) +
         "'>not assessed: the DEM has no height there</td></tr>\n";
}

/// "120 [80 to 300]": the return period of a frequency with its bounds; without an event the lower bound alone. Where
/// the frequency has no upper bound "120 [300 or less]", or "not known".
std::string years_text(std::optional<double> frequency, std::optional<double> low, std::optional<double> high) {
  const auto once_in = [](std::optional<double> f) { return f && *f > 0.0 ? readable(1.0 / *f) : std::string(); };
  const std::string years = once_in(frequency), least = once_in(high), most = once_in(low);
  if (!high) return years.empty() ? "not known" : years + " [" + most + " or less]";
  if (least.empty()) return years.empty() ? "no event" : years;
  return (years.empty() ? "no event" : years) + " [" + least + (most.empty() ? " or more]" : " to " + most + "]");
}

/// "low"; with the classes at the bounds where they differ: "none [none to high]".
std::string class_text(const ObjectsPart::Class& of, const std::vector<std::string>& classes) {
  const auto name = [&](std::optional<std::size_t> c) {
    return c && *c < classes.size() ? classes[*c] : std::string();
  };
  const std::string low = name(of.low), high = name(of.high);
  if (high.empty() && !low.empty()) return name(of.here) + " or higher";
  return name(of.here) + (low == high ? "" : " [" + low + " to " + high + "]");
}

/// "high", or "high; at the first touch medium" where that class differs; "none in this run" where no block has hit.
std::string classes_text(const ObjectsPart::Object& object, const std::vector<std::string>& classes) {
  const std::string largest = class_text(object.hazard_class, classes), entry = class_text(object.entry_class, classes);
  if (largest.empty()) return {};
  return (entry.empty() || entry == largest ? largest : largest + "; at the first touch " + entry) +
         (object.frequency > 0.0 ? "" : " in this run");
}

/// The three sources with the largest shares, which are the first: "cliff 39 37.7 %; cliff 31 21.9 %; cliff 34 7.33 %;
/// and 17 more".
std::string largest_sources(const std::string& sources) {
  constexpr std::size_t kMostSources = 3;
  constexpr std::string_view kEnd = " %; ";  // of one before another; "; " alone may be a part of a name
  std::size_t count = 1, end = 0;
  for (std::size_t at = 0; (at = sources.find(kEnd, at)) != std::string::npos; at += kEnd.size())
    if (count++ == kMostSources) end = at + kEnd.size();
  if (end == 0) return shortened(sources, 300);
  return shortened(sources.substr(0, end), 280) + "and " + std::to_string(count - kMostSources) + " more";
}

Markup object_row(const ObjectsPart::Object& object, const std::vector<std::string>& classes) {
  const bool part = !object.high;
  Markup row =
      "<tr><td>"_html + object.name +
      (part ? " (" + percent(object.without_height, 2) + " of it not assessed: the DEM has no height there)" : "") +
      "</td><td class='n'>" + with_digits(object.frequency, 3) + " [" + with_digits(object.low, 3) +
      (part ? " or more" : ", " + with_digits(*object.high, 3)) + "]</td><td class='n'>" +
      years_text(object.frequency, object.low, object.high) + "</td>";
  for (const std::string& years : object.years) row += "<td class='n'>"_html + years + "</td>";
  if (!classes.empty()) row += "<td>"_html + classes_text(object, classes) + "</td>";
  return row + "<td>" + largest_sources(object.sources) + "</td></tr>\n";
}

void add_object(const CsvTable& table, const CsvTable::Row& row, ObjectsPart& part) {
  const std::string& name = table.text(row, "object");
  const auto number = [&](const std::string& column) { return table.number(row, column, kAny); };
  const auto frequency = number("frequency"), low = number("frequency_lower"), high = number("frequency_upper");
  if (!frequency || !low) {
    if (part.not_assessed.size() < kMostObjects)
      part.not_assessed.push_back(name);
    else
      ++part.not_assessed_left_out;
    return;
  }
  ObjectsPart::Object object;
  object.name = name, object.sources = table.text(row, "sources");
  object.frequency = *frequency, object.low = *low, object.high = high;
  object.without_height = number("share_without_height").value_or(0.0);
  const auto class_in = [&](const std::string& column) -> std::optional<std::size_t> {
    const auto c = number(column);
    return c && *c >= 0.0 && *c < 1e3 ? std::optional(static_cast<std::size_t>(*c)) : std::nullopt;
  };
  const auto bounded_class = [&](const std::string& column) {
    return ObjectsPart::Class{class_in(column), class_in(column + "_lower"), class_in(column + "_upper")};
  };
  object.hazard_class = bounded_class("hazard_class");
  object.entry_class = bounded_class("entry_class");
  for (const std::string& energy : part.thresholds)
    object.years.push_back(years_text(number("frequency_" + energy), number("frequency_" + energy + "_lower"),
                                      number("frequency_" + energy + "_upper")));
  part.objects.push_back(std::move(object));
}

/// Leaves the objects that are hit most often, those first; of equal ones the first of the table.
void keep_most_hit(ObjectsPart& part) {
  std::ranges::stable_sort(part.objects, std::ranges::greater{}, &ObjectsPart::Object::frequency);
  if (part.objects.size() <= kMostObjects) return;
  part.left_out += part.objects.size() - kMostObjects;
  part.objects.resize(kMostObjects);
}

}  // namespace

ObjectsPart read_objects_part(const fs::path& folder, bool with_rotation) {
  ObjectsPart part;
  part.with_rotation = with_rotation;
  const fs::path file = folder / "objects.csv";
  std::error_code none;
  if (!fs::exists(file, none)) return part;
  if (const std::string fault = too_large_for_page(file); !fault.empty()) {
    part.note = fault + ": its objects are not shown.";
    return part;
  }
  bool first = true;
  const auto add = [&part, &first](const CsvTable& table, const CsvTable::Row& row) {
    if (std::exchange(first, false)) read_thresholds(table, part);
    add_object(table, row, part);
    if (part.objects.size() == 10 * kMostObjects) keep_most_hit(part);  // a table of any length needs little memory
  };
  CsvTable(file.string(), {}, {"object", "frequency", "frequency_lower", "frequency_upper", "sources"}, add);
  keep_most_hit(part);
  read_curves(folder / "objects_curves.csv", part);
  return part;
}

Markup objects_html(const ObjectsPart& part, bool pieces, const std::vector<std::string>& classes) {
  const Markup note = part.note.empty() ? Markup() : "<p class='note'>"_html + part.note + "</p>\n";
  if (part.objects.empty() && part.not_assessed.empty())
    return part.note.empty() ? Markup() : "<h2>Objects</h2>\n"_html + note;
  Markup html =
      "<h2>Objects</h2>\n<p>How often each object is hit, with 95 % bounds of the number of blocks in brackets. \"No "
      "event\": no block of this run did it; it may happen all the same, as often as the upper bound. Energies are the "
      "largest within the outline (safe for what does not stop a block: a yard, a road); at the first touch, for a "
      "wall, they are in objects.csv (entry), at a barrier in its table. The class is that of the object by these "
      "frequencies, with the class by the energies at the first touch where that differs; where the classes at the "
      "bounds differ (in brackets), it is not decided: take more trajectories. "
      "The map \"Hazard class\" has that of each cell: the longer an object, "
      "the more often it is hit, and its class may be higher than that of every cell. To compare parts of a road, cut "
      "it into sections of one length. A block counts for each object that it hits, for both of two sections at their "
      "border: do not add up their frequencies. The last column names the three sources that hit it most, with their "
      "shares of the hits; all are in objects_sources.csv.</p>\n"_html;
  if (part.with_rotation) html += "<p>Energies and classes of objects count the rotation.</p>\n";
  if (pieces) html += "<p>Blocks broke, and "_html + kHitsOfPieces + ".</p>\n";
  constexpr std::size_t kFew = 3;  // thresholds
  html += "<div class='wide'><table class='objects"_html + (part.thresholds.size() > kFew ? " many" : "");
  html += "'><tr><th>object</th><th>hits per year [95 %]</th><th>once in [years]</th>"_html;
  for (const std::string& energy : part.thresholds) html += "<th>above "_html + energy + " kJ once in [years]</th>";
  if (!classes.empty()) html += "<th>class</th>"_html;
  html += "<th>from</th></tr>\n";
  for (const std::string& name : part.not_assessed) html += not_assessed_row(name, part, !classes.empty());
  if (part.not_assessed_left_out > 0)
    html += not_assessed_row(std::to_string(part.not_assessed_left_out) + " more objects", part, !classes.empty());
  for (const ObjectsPart::Object& object : part.objects) html += object_row(object, classes);
  html += "</table></div>\n";
  if (part.left_out > 0)
    html +=
        "<p class='note'>"_html + std::to_string(part.left_out) + " more, hit less often, are in objects.csv.</p>\n";
  html += note;
  const Markup curves = curves_drawing(part);
  if (curves.empty()) return html;
  return html + "<figure>" + curves +
         "<figcaption>Hazard curves of the objects that are hit most often, from "
         "objects_curves.csv.</figcaption></figure>\n";
}

}  // namespace talus::io
