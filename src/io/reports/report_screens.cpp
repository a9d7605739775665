#include "report_screens.hpp"

#include <algorithm>
#include <cmath>

#include "io/gdal/csv_table.hpp"
#include "io/results/screen_columns.hpp"
#include "report_facts.hpp"
#include "svg.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

constexpr Bounds kAnyValue{"value", "1", "of a quantity", -1e15, 1e15};
constexpr std::size_t kBins = 30, kMostScreens = 30;

void count_crossings(const fs::path& file, ScreensPart& part) {
  std::error_code none;
  if (!fs::exists(file, none)) return;
  if (const std::string fault = too_large_for_page(file); !fault.empty()) {
    part.note = fault + ": the figures are those of screens_summary.csv, without drawings.";
    return;
  }
  const auto count = [&part](const CsvTable& table, const CsvTable::Row& line) {
    for (ScreensPart::Row& row : part.rows) {
      if (table.text(line, "screen") != row.screen || !(row.maximum > 0.0)) continue;
      const auto quantity = std::ranges::find(kScreenColumns, row.quantity, &ScreenColumn::quantity);
      const auto value = table.number(line, quantity->column, kAnyValue);
      if (!value) continue;
      row.counts.resize(kBins);
      const double place = std::clamp(*value / row.maximum * kBins, 0.0, kBins - 1.0);
      ++row.counts[static_cast<std::size_t>(place)];
    }
  };
  CsvTable(file.string(), {}, {"screen", "speed_ms", "energy_kj", "jump_height_m"}, count);
}

/// Bars of the crossings by value, with lines at P50 and P95.
Markup histogram(const ScreensPart::Row& row) {
  constexpr double kWidth = 300.0, kHeight = 130.0, kLow = 108.0, kTop = 20.0;
  const Axis x{0.0, row.maximum, 10.0, kWidth - 20.0};
  const double most = *std::ranges::max_element(row.counts);
  Svg svg('\'', "");
  for (std::size_t i = 0; i < row.counts.size(); ++i) {
    const double from = row.maximum * static_cast<double>(i) / kBins, height = (kLow - kTop) * row.counts[i] / most;
    svg.element("rect", {{"x", x(from)},
                         {"y", kLow - height},
                         {"width", (kWidth - 20.0) / kBins - 1.0},
                         {"height", height},
                         {"fill", "#5b7fa6"}});
  }
  for (const auto& [value, name] : {std::pair(row.p50, "P50"), {row.p95, "P95"}}) {
    svg.element("line", {{"x1", x(value)}, {"x2", x(value)}, {"y1", kTop}, {"y2", kLow}, {"stroke", "#b3261e"}});
    svg.words({{"x", x(value) + 3.0}, {"y", kTop + 8.0}, {"fill", "#b3261e"}}, name);
  }
  svg.element("line", {{"x1", 10}, {"x2", kWidth - 10.0}, {"y1", kLow}, {"y2", kLow}, {"stroke", "#222"}});
  for (const double tick : ticks(0.0, row.maximum, 5))
    svg.words({{"x", x(tick)}, {"y", kLow + 13.0}, {"text-anchor", "middle"}}, with_digits(tick, 4));
  svg.words({{"x", 10}, {"y", 12}, {"font-weight", "bold"}}, row.quantity + " [" + row.unit + "]");
  return svg.drawing({{"width", kWidth}, {"height", kHeight}, {"viewBox", "0 0 300 130"}});
}

Markup row_html(const ScreensPart::Row& row) {
  const auto figure = [&row](double value) {  // of no crossing there is none
    return "<td class='n'>"_html + (row.crossings > 0.0 ? with_digits(value, 3) : std::string("-")) + "</td>";
  };
  return "<tr><td>"_html + row.screen + "</td><td>" + row.quantity + " [" + row.unit + "]</td><td class='n'>" +
         grouped(row.crossings) + "</td><td class='n'>" + grouped(row.blocks) + "</td><td class='n'>" +
         percent(row.share) + "</td>" + figure(row.p50) + figure(row.p95) + figure(row.p99) + figure(row.maximum) +
         "</tr>\n";
}

}  // namespace

ScreensPart read_screens_part(const fs::path& folder) {
  ScreensPart part;
  const fs::path file = folder / "screens_summary.csv";
  std::error_code none;
  if (!fs::exists(file, none)) return part;
  const CsvTable table(
      file.string(), {},
      {"screen", "quantity", "unit", "crossings", "blocks", "share_of_released", "p50", "p95", "p99", "maximum"});
  for (const CsvTable::Row& line : table.rows()) {
    const auto number = [&](const char* column) { return table.number(line, column, kAnyValue).value_or(0.0); };
    const std::string& quantity = table.text(line, "quantity");
    if (std::ranges::find(kScreenColumns, quantity, &ScreenColumn::quantity) == kScreenColumns.end()) continue;
    if (part.rows.size() == kMostScreens * kScreenColumns.size()) {
      part.note = "Only the first " + std::to_string(kMostScreens) + " screens are shown.";
      break;
    }
    part.rows.push_back({table.text(line, "screen"),
                         quantity,
                         table.text(line, "unit"),
                         number("crossings"),
                         number("blocks"),
                         number("share_of_released"),
                         number("p50"),
                         number("p95"),
                         number("p99"),
                         number("maximum"),
                         {}});
  }
  count_crossings(folder / "screens.csv", part);
  return part;
}

Markup screens_html(const ScreensPart& part) {
  if (part.rows.empty()) return {};
  Markup html =
      "<h2>At the screens</h2>\n<p>Every crossing counts, each block as much as any other; "
      "a block that rolls to and fro crosses several times. Energy is translational, "
      "jump height is from the terrain to the lowest point of the block.</p>\n"
      "<div class='wide'><table><tr><th>screen</th><th>quantity</th><th>crossings</th><th>blocks</th><th>of "
      "all released</th><th>P50</th><th>P95</th><th>P99</th><th>largest</th></tr>\n"_html;
  for (const ScreensPart::Row& row : part.rows) html += row_html(row);
  html += "</table></div>\n";
  if (!part.note.empty()) html += "<p class='note'>"_html + part.note + "</p>\n";
  std::string screen;
  for (const ScreensPart::Row& row : part.rows) {
    if (row.counts.empty()) continue;
    if (row.screen != screen)
      html +=
          (screen.empty() ? "<h3>"_html : "</figure>\n<h3>"_html) + "Crossings of " + row.screen + "</h3>\n<figure>";
    screen = row.screen;
    html += histogram(row);
  }
  return screen.empty() ? html : html + "</figure>\n";
}

}  // namespace talus::io
