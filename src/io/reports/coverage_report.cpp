#include "coverage_report.hpp"

#include <algorithm>
#include <cmath>

#include "svg.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr int kHistogramWidth = 210, kHistogramHeight = 130, kHistogramMargin = 26;  // of a histogram [px]
constexpr double kManyMissing = 0.1, kFewMissing = 3.0;   // of the blocks, and blocks: some stops are not found
constexpr int kHistogramsInRow = 4, kHeadingHeight = 30;  // of a picture [px]

std::string whole_percent(double share) {
  return with_decimals(100.0 * share, 0);
}

std::string name_of_share(std::size_t i) {
  return "P" + whole_percent(kCoverageShares[i]);
}

bool wrong(const ShareBelow& below) {
  return below.corrected < kWrongSpread;
}

/// "12 % (2 to 10)", with a star where a right model hardly gives it.
std::string share_text(const Coverage& c, std::size_t i) {
  const ShareBelow& below = c.below[i];
  return whole_percent(c.share(i)) + " % (" + whole_percent(below.expected.low / c.rows) + " to " +
         whole_percent(below.expected.high / c.rows) + ")" + (wrong(below) ? " *" : "");
}

/// Calls `row` with the cells of each observable: its name, its rows, its shares.
template <class Row>
void for_rows(const std::vector<Coverage>& list, Row row) {
  for (const Coverage& c : list) {
    std::vector<std::string> cells{c.observable, std::to_string(c.rows)};
    for (std::size_t i = 0; i < kCoverageShares.size(); ++i) cells.push_back(share_text(c, i));
    row(cells);
  }
}

/// @param left, top  its place in a picture [px]
Markup histogram(const Coverage& c, int left = 0, int top = 0) {
  const Interval& expected = c.expected_in_class;
  const double highest = std::max<double>(*std::ranges::max_element(c.ranks), expected.high);
  const Axis x{0.0, kRankClasses, kHistogramMargin, kHistogramWidth - 2 * kHistogramMargin};
  const Axis y{highest, 0.0, kHistogramMargin, kHistogramHeight - 2 * kHistogramMargin};
  Svg svg('\'', "");
  svg.element("rect", {{"x", kHistogramMargin},
                       {"y", y(expected.high)},
                       {"width", kHistogramWidth - 2 * kHistogramMargin},
                       {"height", y(expected.low) - y(expected.high)},
                       {"fill", "#ddd"}});
  for (std::size_t i = 0; i < kRankClasses; ++i)
    svg.element("rect", {{"x", x(static_cast<double>(i)) + 1.0},
                         {"y", y(c.ranks[i])},
                         {"width", x(1.0) - x(0.0) - 2.0},
                         {"height", y(0.0) - y(c.ranks[i])},
                         {"fill", "#1f5fa8"},
                         {"fill-opacity", 0.7}});
  svg.words({{"x", kHistogramWidth / 2}, {"y", 14}, {"text-anchor", "middle"}, {"font-weight", "bold"}}, c.observable);
  svg.words({{"x", kHistogramMargin - 4}, {"y", y(highest) + 8.0}, {"text-anchor", "end"}}, with_decimals(highest, 0));
  svg.words({{"x", kHistogramMargin}, {"y", kHistogramHeight - 10}}, "nearer, less");
  svg.words({{"x", kHistogramWidth - kHistogramMargin}, {"y", kHistogramHeight - 10}, {"text-anchor", "end"}},
            "farther, more");
  const std::string width = std::to_string(kHistogramWidth), height = std::to_string(kHistogramHeight);
  return svg.drawing(
      {{"x", left}, {"y", top}, {"width", width}, {"height", height}, {"viewBox", "0 0 " + width + " " + height}});
}

/// What a wrong share says of the model.
std::string meaning(std::size_t i, bool too_many) {
  if (i == 0) return too_many ? "the model's low values are not low enough" : "the model's low values are too low";
  if (i + 1 == kCoverageShares.size())
    return too_many ? "the model's high values are too high" : "the model's high values are not high enough";
  return too_many ? "the model gives too much" : "the model gives too little";
}

}  // namespace

std::string leaving_text(const LeavingTest& t) {
  return "by the model " + with_decimals(t.expected, 1) + " of " + std::to_string(t.blocks) +
         " blocks leave the DEM, " + (t.missing == 0 ? "none did" : "at most " + std::to_string(t.missing) + " did") +
         ": p " + with_digits(t.p_value, 2) +
         (static_cast<double>(t.missing) > t.expected ? "; if all of them did, p " + with_digits(t.p_if_all_left, 2)
                                                      : "");
}

std::string too_few_leave(const ScoredRows& scored) {
  const LeavingTest& t = scored.leaving_trials;
  const double more = static_cast<double>(t.missing) - t.expected;
  if (!(t.p_if_all_left < kWrongSpread) || t.missing == t.blocks ||
      more < std::max(kFewMissing, kManyMissing * static_cast<double>(t.blocks)))
    return {};
  return std::to_string(t.missing) + " of " + std::to_string(t.blocks) + " " + rows_in_words(scored.rows) +
         " blocks have no place of rest; if they left the DEM, the ground stops blocks too early (unsafe): by the "
         "model " +
         with_decimals(t.expected, 1) + " leave it (p " + with_digits(t.p_if_all_left, 2) +
         "); a fit to the run-outs of the others makes that worse: give the stops that are known, and fit on a DEM "
         "that holds all of them";
}

std::string runout_side(const ScoredRows& scored) {
  const auto runout = std::ranges::find(scored.coverage, "runout", &Coverage::observable);
  if (runout == scored.coverage.end()) return {};
  constexpr std::size_t kMedian = 1;
  const ShareBelow& below = runout->below[kMedian];
  const bool too_short = below.count < below.expected.low;
  if (!too_short && !(below.count > below.expected.high)) return {};
  const double rows = runout->rows, share = runout->share(kMedian);
  const Interval right = {below.expected.low / rows, below.expected.high / rows};
  return whole_percent(too_short ? 1.0 - share : share) + " % of " + std::to_string(runout->rows) + " " +
         rows_in_words(scored.rows) + " blocks ran " + (too_short ? "farther" : "less far") +
         " than the model's median (of a right model " + whole_percent(too_short ? 1.0 - right.high : right.low) +
         " to " + whole_percent(too_short ? 1.0 - right.low : right.high) + " %): the model may " +
         (too_short ? "stop blocks too early (unsafe)" : "let blocks go too far");
}

std::string leaving_sentence(const ScoredRows& scored) {
  const LeavingTest& t = scored.leaving_trials;
  if (std::isnan(t.p_value) || (!(t.expected > 0.0) && t.missing == 0) || t.missing == t.blocks) return {};
  return rows_in_words(scored.rows) + " rows: " + leaving_text(t) +
         (t.missing == 0 ? "" : "; run-outs are compared with trials that stay");
}

std::string coverage_lines(const ScoredRows& scored) {
  std::string text;
  if (!scored.coverage.empty())
    text = rows_in_words(scored.rows) +
           " rows: measured values below the simulated percentiles (in brackets 95 % of right models; *: "
           "hardly a right model, p < 0.01 after correction)\n" +
           padded("", 24) + " rows  below P5            below P50           below P95\n";
  for_rows(scored.coverage, [&text](const std::vector<std::string>& cells) {
    text += padded(cells[0], 24) + std::string(5 - std::min<std::size_t>(5, cells[1].size()), ' ') + cells[1];
    for (std::size_t i = 2; i < cells.size(); ++i)
      text += "  " + (i + 1 < cells.size() ? padded(cells[i], 18) : cells[i]);
    text += "\n";
  });
  const std::string leaving = leaving_sentence(scored), side = runout_side(scored);
  if (!side.empty()) text += side + "\n";
  if (leaving.empty()) return text;
  return text + leaving + (scored.leaving_trials.p_value < kWrongSpread || !too_few_leave(scored).empty() ? " *" : "") +
         "\n";
}

std::string coverage_markdown(const std::vector<Coverage>& list) {
  std::string text =
      "| observable | rows | below P5 (expected) | below P50 | below P95 | blocks by rank, in tenths |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  std::size_t next = 0;
  for_rows(list, [&](const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) text += "| " + cell + " ";
    text += "|";
    for (const std::uint32_t count : list[next++].ranks) text += " " + std::to_string(count);
    text += " |\n";
  });
  return text;
}

Markup coverage_html(const std::vector<Coverage>& list) {
  Markup text =
      "<table><tr><th>observable</th><th>rows</th><th>below the simulated P5 (expected)</th>"
      "<th>below P50</th><th>below P95</th></tr>\n"_html;
  for_rows(list, [&text](const std::vector<std::string>& cells) {
    text += "<tr>";
    for (const std::string& cell : cells) text += "<td>"_html + cell + "</td>";
    text += "</tr>\n";
  });
  return text + "</table>\n";
}

Json json_of(const LeavingTest& test) {
  return {{"blocks", test.blocks},
          {"without_place_of_rest", test.missing},
          {"expected", json_of(test.expected)},
          {"p_value", json_of(test.p_value)},
          {"p_value_if_all_left", json_of(test.p_if_all_left)}};
}

Json json_of(const std::vector<Coverage>& list) {
  Json out = Json::array();
  for (const Coverage& c : list) {
    Json entry{{"observable", c.observable}, {"rows", c.rows}, {"rows_without_rank", c.unseen}};
    Json expected = Json::object(), p = Json::object();
    for (std::size_t i = 0; i < kCoverageShares.size(); ++i) {
      entry[name_of_share(i)] = json_of(c.share(i));
      expected[name_of_share(i)] =
          json_of(Interval{c.below[i].expected.low / c.rows, c.below[i].expected.high / c.rows});
      p[name_of_share(i)] = json_of(c.below[i].corrected);
    }
    entry["expected"] = expected;
    entry["p_corrected"] = p;
    entry["ranks"] = c.ranks;
    out.push_back(std::move(entry));
  }
  return out;
}

Markup rank_histograms(const std::vector<Coverage>& list) {
  Markup html = "<p>"_html;
  for (const Coverage& c : list) html += histogram(c);
  return html + "</p>\n";
}

bool has_ranks(std::span<const BeforeAfter> errors) {
  return std::ranges::any_of(errors, [](const BeforeAfter& e) { return !e.after.coverage.empty(); });
}

std::string ranks_picture(std::span<const BeforeAfter> errors) {
  if (!has_ranks(errors)) return {};
  Svg headings;
  Markup histograms;
  int top = 0;
  for (const BeforeAfter& e : errors) {
    if (e.after.coverage.empty()) continue;
    headings.words({{"x", kHistogramMargin}, {"y", top + 20}, {"font-weight", "bold"}},
                   rows_in_words(e.after.rows) +
                       " rows, after the fit: blocks by the rank of what was measured among the simulated; "
                       "grey: 95 % of the bars of a right model");
    top += kHeadingHeight;
    int column = 0;
    for (const Coverage& c : e.after.coverage) {
      histograms +=
          histogram(c, column % kHistogramsInRow * kHistogramWidth, top + column / kHistogramsInRow * kHistogramHeight);
      ++column;
    }
    top += (column + kHistogramsInRow - 1) / kHistogramsInRow * kHistogramHeight;
  }
  return headings
      .drawing(
          {{"xmlns", "http://www.w3.org/2000/svg"}, {"width", kHistogramsInRow * kHistogramWidth}, {"height", top}},
          "<style>text{font-family:sans-serif;font-size:11px}</style><rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"_html +
              histograms)
      .text();
}

std::vector<std::string> coverage_warnings(const ScoredRows& scored) {
  std::vector<std::string> warnings;
  for (const Coverage& c : scored.coverage)
    for (std::size_t i = 0; i < kCoverageShares.size(); ++i) {
      if (!wrong(c.below[i])) continue;
      const bool too_many = c.share(i) > kCoverageShares[i];
      warnings.push_back(c.observable + ": " + whole_percent(c.share(i)) + " % of " + std::to_string(c.rows) + " " +
                         rows_in_words(scored.rows) + " rows lie below the simulated " + name_of_share(i) + ", " +
                         whole_percent(kCoverageShares[i]) + " % should: " + meaning(i, too_many) + " (p " +
                         with_digits(c.below[i].corrected, 2) + " after correction)");
    }
  return warnings;
}

}  // namespace talus::io
