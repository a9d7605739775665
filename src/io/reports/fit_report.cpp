#include "talus/io/reports/fit_report.hpp"

#include <algorithm>
#include <cmath>

#include "coverage_report.hpp"
#include "deposit_report.hpp"
#include "evidence.hpp"
#include "markup.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus::io {
namespace {

constexpr double kCorrelated = 0.5;  // a stronger correlation has a line in the report

Json parameters_of(const Calibration& c) {
  Json list = Json::array();
  for (std::size_t i = 0; i < c.free.size(); ++i) {
    const Parameter& p = c.free[i];
    list.push_back({{"key", p.key},
                    {"unit", p.unit},
                    {"start", json_of(p.get(c.start))},
                    {"value", json_of(p.get(c.fit.model))},
                    {"ci95", json_of(c.uncertainty.intervals[i])},
                    {"identifiable", static_cast<bool>(c.uncertainty.identifiable[i])},
                    {"at_bound", static_cast<bool>(c.uncertainty.at_bound[i])},
                    {"bounds", Json::array({json_of(p.lower), json_of(p.upper)})},
                    {"prior",
                     {{"scale", p.scale == Parameter::Scale::Log ? "log" : "linear"},
                      {"centre", json_of(p.centre)},
                      {"sd", p.sd}}}});
  }
  return list;
}

Json correlation_of(const Calibration& c) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < c.uncertainty.correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < c.uncertainty.correlation.cols(); ++j)
      row.push_back(std::round(c.uncertainty.correlation(i, j) * 1e3) / 1e3);
    rows.push_back(row);
  }
  return rows;
}

Json error_of(const Calibration& c) {
  Json error{{"metric", "mean normalised score"}, {"trials", c.score_trials}};
  for (const BeforeAfter& e : c.errors) {
    Json groups = Json::array();
    for (std::size_t g = 0; g < e.after.score.groups.size(); ++g)
      groups.push_back({{"group", e.after.score.groups[g].name},
                        {"before", json_of(e.before.score.groups[g].score)},
                        {"after", json_of(e.after.score.groups[g].score)},
                        {"climatology", json_of(e.after.climatology.groups[g].score)},
                        {"rows", e.after.score.groups[g].rows},
                        {"rows_as_climatology",
                         {{"before", e.before.score.groups[g].unseen}, {"after", e.after.score.groups[g].unseen}}}});
    error[e.after.rows] = {{"before", json_of(e.before.score.total)},
                           {"after", json_of(e.after.score.total)},
                           {"reduction", json_of(e.reduction.share)},
                           {"ci95", json_of(e.reduction.interval)},
                           {"climatology", json_of(e.after.climatology.total)},
                           {"skill", json_of(e.after.skill.share)},
                           {"skill_ci95", json_of(e.after.skill.interval)},
                           {"leaving", json_of(e.after.leaving_trials)},
                           {"blocks", e.after.blocks},
                           {"groups", groups}};
    if (e.after.deposits) error[e.after.rows]["deposits"] = deposits_json(e.after);
  }
  return error;
}

Json distributions_of(const Comparison& comparison) {
  Json list = Json::array();
  for (const Distribution& d : comparison.distributions) {
    Json measured = Json::array(), simulated = Json::array();
    for (std::size_t i = 0; i < kCompared.size(); ++i) {
      measured.push_back(json_of(d.measured[i]));
      simulated.push_back(json_of(d.simulated[i]));
    }
    list.push_back({{"observable", d.name},
                    {"unit", d.unit},
                    {"quantiles", kCompared},
                    {"measured", measured},
                    {"simulated", simulated},
                    {"measured_values", d.measured_count}});
  }
  for (const CrossingShare& s : comparison.crossings)
    list.push_back({{"observable", "crossed " + s.screen},
                    {"unit", "share"},
                    {"measured", json_of(s.measured)},
                    {"simulated", json_of(s.simulated)}});
  return list;
}

std::string parameter_lines(const Calibration& c) {
  std::string text = "| parameter | start | fitted | 95 % interval | |\n| --- | --- | --- | --- | --- |\n";
  for (std::size_t i = 0; i < c.free.size(); ++i) {
    const Parameter& p = c.free[i];
    const Interval& interval = c.uncertainty.intervals[i];
    const bool known = c.uncertainty.identifiable[i];
    text += "| " + p.key + (p.unit.empty() ? "" : " [" + p.unit + "]") + " | " + with_digits(p.get(c.start), 3) +
            " | " + (known ? with_digits(p.get(c.fit.model), 3) : "(" + with_digits(p.get(c.fit.model), 3) + ")") +
            " | " + with_digits(interval.low, 3) + " to " + with_digits(interval.high, 3) + " | " +
            interval_note(known, c.uncertainty.at_bound[i]) + " |\n";
  }
  return text;
}

std::string correlation_lines(const Calibration& c) {
  std::string text;
  for (Eigen::Index i = 0; i < c.uncertainty.correlation.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (std::abs(c.uncertainty.correlation(i, j)) >= kCorrelated)
        text += "- " + c.free[static_cast<std::size_t>(j)].key + " and " + c.free[static_cast<std::size_t>(i)].key +
                ": " + with_decimals(c.uncertainty.correlation(i, j), 2) + "\n";
  return text.empty() ? "None of " + with_digits(kCorrelated, 3) + " or more.\n" : text;
}

std::string error_lines(const Calibration& c) {
  std::string text;
  for (const BeforeAfter& e : c.errors) {
    text += "### " + rows_in_words(e.after.rows) + " rows (" + std::to_string(e.after.blocks) + " blocks)\n\n";
    if (e.after.score.groups.empty()) {
      text += "No group has five rows: nothing can be said.\n\n";
      continue;
    }
    text += "| group | before | after | climatology | rows |\n| --- | --- | --- | --- | --- |\n";
    for (std::size_t g = 0; g < e.after.score.groups.size(); ++g)
      text += "| " + e.after.score.groups[g].name + " | " + with_decimals(e.before.score.groups[g].score, 3) + " | " +
              with_decimals(e.after.score.groups[g].score, 3) + " | " +
              with_decimals(e.after.climatology.groups[g].score, 3) + " | " + rows_text(e.after.score.groups[g]) +
              " |\n";
    text += "| **mean** | **" + with_decimals(e.before.score.total, 3) + "** | **" +
            with_decimals(e.after.score.total, 3) + "** | **" + with_decimals(e.after.climatology.total, 3) + "** | " +
            std::to_string(e.after.score.rows.size()) + " |\n\n";
    text += "The fit lowers the error by " + gain_of_fit(e) + ".\n\n" + judgement_markdown(e, "ranks.svg");
  }
  return text;
}

std::string distribution_lines(const Comparison& comparison) {
  std::string text =
      "| | | 5 % | 25 % | 50 % | 75 % | 95 % | values |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const Distribution& d : comparison.distributions)
    for (const bool measured : {true, false}) {
      text += "| " + (measured ? d.name + " [" + d.unit + "]" : std::string()) +
              (measured ? " | measured" : " | simulated");
      for (const double value : measured ? d.measured : d.simulated) text += " | " + with_digits(value, 3);
      text += " | " + std::to_string(measured ? d.measured_count : d.simulated_count) + " |\n";
    }
  for (const CrossingShare& s : comparison.crossings)
    text += "\nCrossed " + s.screen + ": " + percent(s.measured) + " of the blocks, " + percent(s.simulated) +
            " of the simulated ones.\n";
  return text;
}

}  // namespace

std::string gain_of_fit(const BeforeAfter& e) {
  if (hardly_simulated(e.before.score) || hardly_simulated(e.after.score))
    return "an amount that cannot be told: start or fit hardly simulates what was measured";
  return with_decimals(100.0 * e.reduction.share, 1) + " % (95 % interval over the " +
         (e.clusters.are_groups() ? "groups" : "blocks") + ": " + interval_text(e.reduction.interval, 100.0, 1) + " %)";
}

std::string calibration_json(const Calibration& c) {
  Json json{{"program", "talus"},
            {"version", version()},
            {"command", c.command},
            {"campaign", c.campaign},
            {"surface", {{"value", c.surface}, {"source", c.surface_from}}},
            {"seed", c.options.seed},
            {"trials", c.options.trials},
            {"cut_short", json_of(c.fit.score.cut_short)},
            {"comparison_trials", c.options.comparison_trials},
            {"starts", c.options.starts},
            {"start_model", c.start_name},
            {"evaluations", c.fit.tried},
            {"objective", json_of(c.fit.objective)},
            {"prior_weight", c.options.prior_weight},
            {"parameters", parameters_of(c)},
            {"correlation", correlation_of(c)},
            {"not_fitted_zones", c.untouched},
            {"error", error_of(c)},
            {"tail", tail_json(c.errors)},
            {"coverage", coverage_json(c.errors)},
            {"distributions", distributions_of(c.comparison)}};
  json["inputs"] = json_of(c.inputs);
  json["warnings"] = c.warnings;
  json["files"] = {"calibration.json", "report.md", "fitted.toml"};
  if (has_ranks(c.errors)) json["files"].push_back("ranks.svg");
  return json_text(json);
}

std::string interval_note(bool identifiable, bool at_bound) {
  if (!at_bound) return identifiable ? "" : "not identifiable";
  return std::string(identifiable ? "" : "not identifiable, ") + "ends at the bound of the search";
}

std::string bound_warning(const std::string& key, const Interval& interval) {
  return key + ": its 95 % interval, " + with_digits(interval.low, 3) + " to " + with_digits(interval.high, 3) +
         ", ends at the bound of the search, not where the data end it: "
         "start elsewhere (--parameters) and keep the fit of the least error";
}

std::string calibration_report(const Calibration& c) {
  std::string text = "# Calibration on " + c.campaign + "\n\nOn the " + c.surface + " surface (" + c.surface_from +
                     ").\n\n## Parameters\n\n" + parameter_lines(c) + "\n";
  text +=
      "Intervals: 400 fits to blocks with random weights (Bayesian bootstrap; of six groups or more by group), each "
      "with its own draw of the prior (normal; of the logarithm where the scale is one, with a factor of e, around the "
      "start). **Not identifiable**: the interval is "
      "wider than half of what the prior or the bounds allow; the number in brackets is one of many that do as well. "
      "The intervals hold if the model is right; they do not say that it is.\n\n";
  for (const std::string& zone : c.untouched)
    text += "Zone " + zone + ": too few simulated paths touch it; its parameters are those of the start, " +
            c.start_name + ".\n\n";
  text += "## Correlations of " + with_digits(kCorrelated, 3) + " or more\n\n" + correlation_lines(c) + "\n";
  text += "## Error\n\nMean normalised score, " + std::to_string(c.score_trials) +
          " trials per block that the search has not seen. 0: the model gives the measured value exactly; about 0.56: "
          "it knows only the spread of the measurements. Before: " +
          c.start_name + (c.start_name == kDefaultPreset ? " everywhere" : "") +
          ". Held-out rows took no part in the fit. What was minimised is the same with groups of n rows "
          "that count n / (n + 10).\n\n" +
          error_lines(c);
  text +=
      "## Measured and simulated, all blocks\n\nQuantiles over all blocks, simulated with the measurement error.\n\n" +
      distribution_lines(c.comparison);
  for (const std::string& warning : c.warnings) text += "\nWarning: " + warning + "\n";
  return markdown_without_html(text);
}

}  // namespace talus::io
