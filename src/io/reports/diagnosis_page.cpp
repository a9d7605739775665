#include "talus/io/reports/diagnosis_page.hpp"

#include <algorithm>
#include <cmath>

#include "coverage_report.hpp"
#include "diagnosis_summary.hpp"
#include "evidence.hpp"
#include "limits_report.hpp"
#include "page_frame.hpp"
#include "repeated_report.hpp"
#include "svg.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr int kPlotWidth = 330, kPlotHeight = 190, kMargin = 34;  // of a plot [px]
constexpr double kHighestZ = 3.5;                                 // z at the rim of a plot
constexpr std::size_t kPlots = 6;
constexpr char kAboutPoints[] =
    "<p>Each point is a block; z is where its measurement lies among what the model simulates for it, as a standard "
    "normal number: above 0 it is larger than most of the simulated ones. Grey: 95 % of the points of a right "
    "model.</p>\n";

std::string reduction_text(const Reduction& r) {
  if (std::isnan(r.share)) return "-";
  if (r.share == 0.0 && r.interval.low == 0.0 && r.interval.high == 0.0) return "0: it was fitted to no effect";
  return with_decimals(100.0 * r.share, 1) + " % (" + interval_text(r.interval, 100.0, 1) + ")";
}

/// The value of a property of a block, named by a row of the residual table; the number of the block if there is none
/// of this name.
double property_of(const MeasuredBlock& b, const std::string& name, std::size_t number) {
  for (const Property& property : properties())
    if (name == property.name) return property.of(b);
  return static_cast<double>(number + 1);
}

/// A property with its unit.
std::string labelled(const std::string& name) {
  for (const Property& property : properties())
    if (name == property.name && *property.unit != '\0') return name + " [" + property.unit + "]";
  return name;
}

struct Points {
  std::vector<double> x, z;
};

Points points_of(const Campaign& campaign, const ResidualSpace& space, const ResidualRow& row) {
  Points points;
  const std::vector<bool> rows = fitting_rows(campaign);
  for (std::size_t o = 0; o < space.observables().size(); ++o) {
    if (space.observables()[o].name != row.observable) continue;
    for (std::size_t b = 0; b < campaign.blocks.size(); ++b) {
      if (!rows[b]) continue;
      const double z = space.of_measured(b)[static_cast<Eigen::Index>(o)];
      const double x = property_of(campaign.blocks[b], row.covariate, b);
      if (std::isnan(z) || std::isnan(x)) continue;
      points.x.push_back(x);
      points.z.push_back(z);
    }
  }
  return points;
}

/// A scatter plot of z against a property; the grey band holds 95 % of the points if the model is right.
Markup plot(const Points& points, const std::string& title, const std::string& below) {
  const double low = points.x.empty() ? 0.0 : *std::min_element(points.x.begin(), points.x.end());
  const double high = points.x.empty() ? 1.0 : *std::max_element(points.x.begin(), points.x.end());
  const auto share = [=](double value) { return high > low ? (value - low) / (high - low) : 0.5; };
  const Axis x{0.0, 1.0, kMargin, kPlotWidth - 2 * kMargin},
      y{kHighestZ, -kHighestZ, kMargin, kPlotHeight - 2 * kMargin};
  Svg svg('\'', "");
  svg.element("rect", {{"x", kMargin},
                       {"y", y(1.96)},
                       {"width", kPlotWidth - 2 * kMargin},
                       {"height", y(-1.96) - y(1.96)},
                       {"fill", "#eee"}});
  svg.element("line",
              {{"x1", kMargin}, {"x2", kPlotWidth - kMargin}, {"y1", y(0.0)}, {"y2", y(0.0)}, {"stroke", "#999"}});
  for (std::size_t i = 0; i < points.x.size(); ++i)
    svg.element("circle", {{"cx", x(share(points.x[i]))},
                           {"cy", y(std::clamp(points.z[i], -kHighestZ, kHighestZ))},
                           {"r", 2.6},
                           {"fill", "#1f5fa8"},
                           {"fill-opacity", 0.7}});
  for (const double z : {-2.0, 0.0, 2.0})
    svg.words({{"x", kMargin - 4}, {"y", y(z) + 4.0}, {"text-anchor", "end"}}, with_digits(z, 6));
  svg.words({{"x", kMargin - 4}, {"y", y(kHighestZ) + 4.0}, {"text-anchor", "end"}}, "z");
  svg.words({{"x", kMargin}, {"y", kPlotHeight - 18}}, with_digits(low, 4));
  svg.words({{"x", kPlotWidth - kMargin}, {"y", kPlotHeight - 18}, {"text-anchor", "end"}}, with_digits(high, 4));
  svg.words({{"x", kPlotWidth / 2}, {"y", 14}, {"text-anchor", "middle"}, {"font-weight", "bold"}}, title);
  svg.words({{"x", kPlotWidth / 2}, {"y", kPlotHeight - 4}, {"text-anchor", "middle"}}, below);
  const std::string width = std::to_string(kPlotWidth), height = std::to_string(kPlotHeight);
  return svg.drawing({{"width", width}, {"height", height}, {"viewBox", "0 0 " + width + " " + height}});
}

/// Plots of the most significant residuals before and after.
Markup plots(const Campaign& campaign, const Diagnosis& d, const DiagnosisRules& rules, std::size_t most) {
  const ResidualSpace before(campaign, d.base.runs, rules), after(campaign, d.with_effects.runs, rules);
  Markup html;
  const std::vector<ResidualRow>& rows = d.rounds.front().residual;
  for (std::size_t i = 0; i < std::min(most, rows.size()); ++i) {
    if (rows[i].observable == kLeaving) continue;  // a number of all blocks
    const bool by_block = rows[i].covariate == "mean" || rows[i].covariate == "spread";
    const std::string title = rows[i].observable + " against " + (by_block ? "block" : rows[i].covariate);
    const std::string across = by_block ? "number of the block, in the order of the ids" : labelled(rows[i].covariate);
    html += "<p>"_html + plot(points_of(campaign, before, rows[i]), title + ", before", across);
    if (d.rounds.size() > 1) html += plot(points_of(campaign, after, rows[i]), title + ", after", across);
    html += "</p>\n";
  }
  return html;
}

/// The error before and after, beside the climatology's, in all and by group.
Markup errors_html(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  const auto row = [](const Markup& rows, double before, double after, const Reduction* reduction) {
    return "<tr><td>"_html + rows + "</td><td>" + score_text(before) + "</td><td>" + score_text(after) + "</td><td>" +
           (reduction != nullptr ? reduction_text(*reduction) : "") + "</td></tr>\n";
  };
  Markup html =
      "<h2>Error before and after</h2>\n<table><tr><th></th><th>ground fitted</th><th>with what was found</th>"
      "<th>reduction, 95 %</th></tr>\n"_html;
  const std::vector<std::string> small = small_groups(record);
  const std::string unseen = rows_in_words(record.errors[record.unseen].after.rows) + " rows";
  const std::string fitted =
      choice_has_seen(record) ? " (not fitted, but the choice has seen them)" : " (never fitted)";
  if (!small.empty())
    html += row("<b>"_html + unseen + fitted + ", groups of " + std::to_string(kHeadlineRows) + " rows and more</b>",
                record.headline.before, record.headline.after, &record.headline.reduction);
  html += row(small.empty() ? "<b>"_html + unseen + fitted + "</b>" : Markup() + unseen + ", all groups",
              record.whole.before, record.whole.after, &record.whole.reduction);
  html += row("fitting rows"_html, d.base.score.total, d.with_effects.score.total, nullptr) + "</table>\n";
  html +=
      "<p>Mean normalised score. 0: the model gives the measured value exactly; about 0.56: it knows only the spread "
      "of the measurements. Climatology: the measurements of the fitting blocks (of a fitting block those of the "
      "others) in the place of a model. Where blocks were released at several places, the sentences below also "
      "compare with the climatology by release: the ways of the fitting blocks from their releases, begun at the "
      "release of each block.</p>\n";
  for (const BeforeAfter& e : record.errors)
    for (const std::string& sentence : {skill_sentence(e.after), tail_before_after(e), leaving_sentence(e.after)})
      if (!sentence.empty()) html += "<p>"_html + sentence + "</p>\n";
  for (const BeforeAfter& e : record.errors) html += groups_html(e) + "<br>\n";
  if (!small.empty())
    html += "<p>* fewer than "_html + std::to_string(kHeadlineRows) + " rows: one block may rule the group.</p>\n";
  return html;
}

/// How the measured values lie among the simulated ones.
Markup spread_html(const DiagnosisRecord& record) {
  Markup html =
      "<h2>Calibration of the spread</h2>\n<p>Measured values below percentiles of the values simulated for the same "
      "block: 5, 50 and 95 % in a right model (in brackets what 95 % of right models give; *: hardly a right model). "
      "Below, the blocks by the rank of their measurement among the simulated values, in tenths: high at both ends "
      "where the model scatters too little, in the middle where it scatters too much. "
      "Grey: 95 % of the bars of a right model.</p>\n"_html;
  for (const BeforeAfter& e : record.errors)
    for (const ScoredRows* scored : {&e.before, &e.after}) {
      const bool after = scored == &e.after;
      if (scored->coverage.empty() || (!after && record.diagnosis.rounds.size() < 2)) continue;
      html += "<h3>"_html + rows_in_words(e.after.rows) + " rows, " +
              (record.diagnosis.rounds.size() < 2 ? "ground fitted"
               : after                            ? "with what was found"
                                                  : "ground alone") +
              "</h3>\n" + coverage_html(scored->coverage) + rank_histograms(scored->coverage);
    }
  return html;
}

Markup candidates_table(const DiagnosisRound& round, const std::vector<HoldoutError>& holdout) {
  Markup html =
      "<table><tr><th>effect</th><th>where</th><th>parameters</th><th>p of the score test</th><th>objective lower "
      "by (fitting rows, 95 %)</th><th>in cross-validation</th><th>held-out error after</th><th>reduction, 95 "
      "%</th></tr>\n"_html;
  for (std::size_t i = 0; i < round.candidates.size(); ++i) {
    const FittedCandidate& c = round.candidates[i];
    Markup numbers;
    for (std::size_t k = 0; k < c.parameters.size(); ++k)
      numbers += Markup() + c.parameters[k].key + " = " + with_digits(c.values[k], 3) +
                 unit_text(c.parameters[k].unit) + "<br>";
    const HoldoutError& e = holdout[i];
    html += "<tr><td>"_html + c.effect + "</td><td>" + c.where + "</td><td>" + numbers + "</td><td>" +
            with_decimals(c.p_value, 4) + "</td><td>" + gain_text(c.gain, c.gain_interval) + "</td><td>" +
            gain_text(c.cross_validated, c.cross_validated_interval) + "</td><td>" + score_text(e.after) + "</td><td>" +
            reduction_text(e.reduction) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

/// The numbers of the ground, where they began and where they are.
Markup ground_html(const Diagnosis& d) {
  const std::vector<Parameter>& free = d.base.free;
  if (free.empty()) return {};
  const bool more = d.rounds.size() > 1, with_range = d.base.spread.rows() == d.base.z.size();
  Markup html =
      "<h2>The ground that was fitted</h2>\n<p>"_html + std::to_string(free.size()) + " numbers, by " +
      std::to_string(std::ranges::count(d.base.runs, false, [](const BlockRuns& r) { return r.trials == 0; })) +
      " blocks. Start: the middle of the prior, which also holds a number that the blocks say little of. The error "
      "hardly changes within the range: it is no confidence interval (talus calibrate gives "
      "these).</p>\n<table><tr><th>"
      "number</th><th>start</th><th>ground alone</th><th>range</th>" +
      (more ? "<th>with what was found</th>"_html : ""_html) + "</tr>\n";
  for (std::size_t i = 0; i < free.size(); ++i) {
    const Parameter& p = free[i];
    const auto k = static_cast<Eigen::Index>(i);
    const auto at = [&](double z) { return with_digits(p.value(p.within(z)), 3); };
    html += "<tr><td class='b'>"_html + p.key + "</td><td>" + with_digits(p.centre, 3) + unit_text(p.unit) +
            "</td><td>" + at(d.base.z[k]) + "</td><td>";
    if (with_range) {
      const double reach = std::sqrt(d.base.spread(k, k));
      html += at(d.base.z[k] - reach) + " to " + at(d.base.z[k] + reach);
    }
    html += "</td>";
    if (more) html += "<td>"_html + with_digits(p.get(d.with_effects.model), 3) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

/// The tests of the families, with what each found.
Markup families_table(const DiagnosisRound& round) {
  Markup html =
      "<table><tr><th>family</th><th>p</th><th>corrected</th><th>effects in it</th><th>what was compared (p of it "
      "alone)</th><th></th></tr>\n"_html;
  for (const FamilyTest& family : round.families) {
    Markup members, parts;
    for (const std::string& member : family.members) members += Markup() + member + "<br>";
    for (const FamilyPart& part : family.parts)
      parts += Markup() + part.name + ": " + part.statistic + " " + with_decimals(part.value, 2) +
               (std::isnan(part.p_value) ? "" : " (" + with_digits(part.p_value, 2) + ")") + "<br>";
    html += "<tr><td>"_html + family.name + "</td><td>" +
            (std::isnan(family.p_value) ? "not tested" : with_digits(family.p_value, 2)) + "</td><td>" +
            (std::isnan(family.p_corrected) ? "" : with_digits(family.p_corrected, 2)) + "</td><td>" + members +
            "</td><td>" + parts + "</td><td>" + family.note + "</td></tr>\n";
  }
  return html + "</table>\n";
}

Markup residual_rows(const std::vector<ResidualRow>& rows) {
  Markup html =
      "<table><tr><th>observable</th><th>against</th><th>statistic</th><th>p</th><th>corrected</th><th>blocks</th></"
      "tr>\n"_html;
  for (std::size_t i = 0; i < std::min<std::size_t>(12, rows.size()); ++i)
    html += "<tr><td>"_html + rows[i].observable + "</td><td>" + rows[i].covariate + "</td><td>" +
            with_decimals(rows[i].statistic, 2) + "</td><td>" + with_digits(rows[i].p_value, 2) + "</td><td>" +
            with_digits(rows[i].corrected, 2) + "</td><td>" + std::to_string(rows[i].blocks) + "</td></tr>\n";
  return html + "</table>\n";
}

/// Where place and instrument were tested.
Markup settling_text(const Settling& settling) {
  if (std::isnan(settling.statistic)) return {};
  Markup html = "<p>Place and instrument were tested "_html;
  if (settling.farthest > 0.0)
    html += "where the fitted numbers have settled, up to " + with_decimals(settling.farthest, 1) +
            " standard deviations of the prior from the fit: their score statistic is " +
            with_digits(settling.statistic, 2) + ", at the fit " + with_digits(settling.statistic_of_fit, 2);
  else
    html += "at the fit: the score statistic of its numbers is " + with_digits(settling.statistic, 2);
  html += " (in a right model " + std::to_string(settling.parameters) + " on average).";
  if (settling.statistic > 2.0 * static_cast<double>(settling.parameters))
    html += " <b>They did not settle: these p may be too small.</b>"_html;
  return html + "</p>\n";
}

/// The families that are significant, and those that could not name anything.
/// @param level  of significance in this round
Markup families_sentence(const DiagnosisRound& round, double level) {
  Markup text;
  for (const FamilyTest& family : round.families) {
    if (family.p_corrected <= level)
      text += Markup() + (text.empty() ? " The residual before this round depends on: " : ", ") + "<b>" + family.name +
              "</b> (p " + with_digits(family.p_corrected, 2) + " corrected)";
  }
  if (!text.empty()) text += ".";
  for (const FamilyTest& family : round.families)
    if (!family.may_name)
      text +=
          " "_html + family.note + (std::isnan(family.p_value) ? "" : ", p " + with_digits(family.p_value, 2)) + ".";
  return text;
}

Markup residual_sentence(const DiagnosisRound& round, double level) {
  const std::string text = residual_text(round, level);
  return text.empty() ? Markup() : " In the residual table "_html + text + ".";
}

/// @param level  of significance in this round
Markup sentence(const DiagnosisRound& round, double level) {
  const bool rare = round.p_value <= level || (!round.residual.empty() && round.residual.front().corrected <= level);
  if (!round.tried) return "What is left is unlikely to be noise; no further effect was tried (--most-effects)."_html;
  if (round.effect == "none" && !rare) return "Nothing is left that differs from noise."_html;
  if (round.effect == "none")
    return "What is left is unlikely to be noise, but no effect of the library can be named for it."_html;
  if (round.effect == "unexplained")
    return "A residual is left that no effect of the library explains better than chance."_html;
  Markup text = "The model lacks <b>"_html + round.effect + "</b> (" + round.where + ").";
  if (!round.alike.empty()) {
    text += " On these data it cannot be told apart from: ";
    for (std::size_t i = 0; i < round.alike.size(); ++i) text += Markup() + (i > 0 ? ", " : "") + round.alike[i];
    text += ".";
  }
  return text;
}

/// The warnings, on the first screen: some of them decide whether the verdict can be used.
Markup warning_lines(const DiagnosisRecord& record) {
  Markup html;
  for (const std::string& warning : record.warnings) html += "<p><b>Warning:</b> "_html + warning + "</p>\n";
  return html;
}

}  // namespace

std::string diagnosis_page(const Campaign& campaign, const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  Markup html = summary_html(record) + warning_lines(record) + plots(campaign, d, record.options.rules, 1) +
                kAboutPoints + "<h2>Rounds</h2>\n";
  for (std::size_t i = 0; i < d.rounds.size(); ++i) {
    const double level = record.options.level_of_round(i);
    html += "<p>Round "_html + std::to_string(i + 1) + ":" + families_sentence(d.rounds[i], level) +
            residual_sentence(d.rounds[i], level) + " " + sentence(d.rounds[i], level) +
            " (Smallest corrected p of a family: " + with_decimals(d.rounds[i].p_value, 4) + ".)</p>\n";
  }
  if (const std::string undecided = undecided_text(d.stability); !undecided.empty())
    html += "<p><b>The first round is "_html + undecided + "</b>: independent base fits differ.</p>\n";
  html += errors_html(record) + repeated_html(record) + ground_html(d) + spread_html(record);
  html +=
      "<h2>Families</h2>\n<p>Effects that leave the same kind of trace are tested together, by one test of few degrees "
      "of freedom. Only an effect of a significant family may be named. "
      "How often p is 5 % or less in campaigns without an effect: docs/diagnosis-results.md.</p>\n";
  for (std::size_t i = 0; i < d.rounds.size(); ++i)
    html += "<h3>Round "_html + std::to_string(i + 1) + "</h3>\n" + families_table(d.rounds[i]) +
            settling_text(d.rounds[i].settling);
  html +=
      "<h2>Candidates</h2>\n<p>Each at its best place, fitted together with the ground where it may be named, else "
      "with the ground held. The objective is the error with groups of n rows that count n / (n + 10). The p of the "
      "score test orders the candidates; the p of the family decides.</p>\n";
  for (std::size_t i = 0; i < d.rounds.size(); ++i)
    if (!d.rounds[i].candidates.empty())
      html += "<h3>Round "_html + std::to_string(i + 1) + (i > 0 ? ", with what was found before in the model" : "") +
              "</h3>\n" + candidates_table(d.rounds[i], record.candidates[i]);
  html +=
      "<h2>What could not have been seen</h2>\n<p>The amount from which on these data begin to show each effect, "
      "after the ground has been fitted anew: 4.5 standard errors of a linear test. "
      "Effects that do not grow linearly are seen from larger amounts on (on one synthetic campaign the printed amounts had 1.8 to 4.9).</p>\n"_html +
      limits_html(d.rounds.back().limits);
  html += "<h2>Residuals</h2>\n"_html + kAboutPoints + plots(campaign, d, record.options.rules, kPlots) +
          "<h3>Before</h3>\n" + residual_rows(d.rounds.front().residual);
  if (d.rounds.size() > 1) html += "<h3>After</h3>\n"_html + residual_rows(d.rounds.back().residual);
  const std::string footer = "seed " + std::to_string(record.options.seed) + ", " + record.surface + " surface, " +
                             with_decimals(record.seconds, 0) + " s";
  return page_of({"diagnose", "What the model of " + campaign.name + " lacks", footer}, html);
}

}  // namespace talus::io
