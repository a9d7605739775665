#include "talus/io/reports/sites_calibration.hpp"

#include "coverage_report.hpp"
#include "evidence.hpp"
#include "markup.hpp"
#include "sites_evidence.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/io/reports/fit_report.hpp"

namespace talus::io {
namespace {

std::string sharing_sentence(const SitesCalibration& c) {
  if (c.share.empty())
    return "Nothing is shared (--share NAME): each site was fitted alone, which is the same as separate calls of talus "
           "calibrate.";
  return "One objective for all sites. Shared: " + joined(c.share) + "; all else is each site's own.";
}

Json parameters_json(const SitesCalibration& c) {
  Json list = Json::array();
  for (const SitesParameter& p : c.parameters)
    list.push_back({{"key", p.key},
                    {"unit", p.unit},
                    {"sites", p.sites},
                    {"shared", p.sites.size() > 1},
                    {"start", json_of(p.start)},
                    {"value", json_of(p.value)},
                    {"ci95", json_of(p.interval)},
                    {"identifiable", p.identifiable},
                    {"at_bound", p.at_bound}});
  return list;
}

}  // namespace

std::string sites_calibration_json(const SitesCalibration& c) {
  Json sites = Json::array(), files = Json::array({"calibration.json", "report.md"});
  for (std::size_t i = 0; i + 1 < c.evidence.size(); ++i) {
    const SiteEvidence& e = c.evidence[i];
    sites.push_back({{"name", e.site},
                     {"campaign", c.files[i]},
                     {"error", errors_json(e)},
                     {"evidence", evidence_json(e.errors, e.clusters, "start", "fitted")},
                     {"coverage", coverage_json(e.errors)},
                     {"tail", tail_json(e.errors)}});
    files.push_back(e.site + "/fitted.toml");
    if (has_ranks(e.errors)) files.push_back(e.site + "/ranks.svg");
  }
  Json json{{"program", "talus"},
            {"version", version()},
            {"command", c.command},
            {"shared", c.share},
            {"separate_fits", c.share.empty()},
            {"seed", c.options.seed},
            {"trials", c.options.trials},
            {"comparison_trials", c.options.comparison_trials},
            {"starts", c.options.starts},
            {"prior_weight", c.options.prior_weight},
            {"cut_short", json_of(c.cut_short)},
            {"parameters", parameters_json(c)},
            {"error", errors_json(c.evidence.back())},
            {"sites", sites}};
  json["inputs"] = json_of(c.inputs);
  json["warnings"] = c.warnings;
  json["files"] = files;
  return json_text(json);
}

std::string sites_calibration_report(const SitesCalibration& c) {
  std::string text =
      "# Calibration on " + names_in_words(c.evidence) + "\n\n" + sharing_sentence(c) +
      "\n\n## Parameters\n\n| parameter | sites | start | fitted | 95 % interval | |\n| --- | --- | --- | "
      "--- | --- | --- |\n";
  for (const SitesParameter& p : c.parameters)
    text += "| " + p.key + (p.unit.empty() ? "" : " [" + p.unit + "]") + " | " + joined(p.sites) + " | " +
            with_digits(p.start, 3) + " | " + with_digits(p.value, 3) + " | " + with_digits(p.interval.low, 3) +
            " to " + with_digits(p.interval.high, 3) + " | " + interval_note(p.identifiable, p.at_bound) + " |\n";
  text += "\n## Error, by site and pooled\n\n" + evidence_markdown(c.evidence) + "\n";
  for (std::size_t i = 0; i + 1 < c.evidence.size(); ++i)
    text += "## " + c.evidence[i].site + ", fitting rows\n\n" +
            judgement_markdown(c.evidence[i].errors.front(), c.evidence[i].site + "/ranks.svg");
  for (const std::string& warning : c.warnings) text += "\nWarning: " + warning + "\n";
  return markdown_without_html(text);
}

std::string sites_calibration_summary(const SitesCalibration& c) {
  std::string text = sharing_sentence(c) + "\n";
  for (const SitesParameter& p : c.parameters) {
    const std::string note = interval_note(p.identifiable, p.at_bound);
    text += p.key + (p.sites.size() > 1 ? " (shared)" : "") + ": " + with_digits(p.value, 3) +
            ", 95 %: " + with_digits(p.interval.low, 3) + " to " + with_digits(p.interval.high, 3) +
            (note.empty() ? "" : ", " + note) + "\n";
  }
  for (const SiteEvidence& e : c.evidence)
    for (const auto& [name, change] : {std::pair{"fitting", e.fit}, {"held-out", e.unseen}})
      if (change.rows > 0)
        text += "error, " + e.site + ", " + name + " rows (" + std::to_string(change.blocks) +
                " blocks): " + score_text(change.before) + " before, " + score_text(change.after) +
                " after (lower by " + change_text(change) + "), climatology " + score_text(change.climatology) + "\n";
  if (c.cut_short > 0.0) text += cut_short_line(c.cut_short, c.options.rules.most_vertices) + "\n";
  return text;
}

}  // namespace talus::io
