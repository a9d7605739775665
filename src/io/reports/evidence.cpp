#include "evidence.hpp"

#include <algorithm>
#include <cmath>

#include "coverage_report.hpp"
#include "deposit_report.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kResidualRows = 20;

std::string tenths_of_percent(double share) {
  return with_decimals(100.0 * share, 1);
}

JudgedModel of_climatology(const BeforeAfter& e) {
  return {e.after.climatology, e.after.log_climatology};
}
JudgedModel of_before(const BeforeAfter& e) {
  return {e.before.score, e.before.log_score};
}
JudgedModel of_after(const BeforeAfter& e) {
  return {e.after.score, e.after.log_score};
}

/// One model on rows of all kinds.
Json entry_of(const char* name, std::span<const BeforeAfter> errors, std::span<const std::uint32_t> clusters,
              JudgedModel (*model)(const BeforeAfter&)) {
  Json entry{{"model", name}};
  for (const BeforeAfter& e : errors) entry[e.after.rows] = judged_json(model(e), of_before(e), clusters);
  return entry;
}

}  // namespace

std::string rows_text(const GroupScore& group) {
  return std::to_string(group.rows) + (group.rows < kHeadlineRows ? " *" : "");
}

Json residual_json(std::span<const ResidualRow> rows) {
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(kResidualRows, rows.size()); ++i)
    list.push_back({{"observable", rows[i].observable},
                    {"covariate", rows[i].covariate},
                    {"statistic", json_of(rows[i].statistic)},
                    {"p_value", json_of(rows[i].p_value)},
                    {"p_corrected", json_of(rows[i].corrected)},
                    {"blocks", rows[i].blocks}});
  return list;
}

Json coverage_json(std::span<const BeforeAfter> errors) {
  Json before = Json::object(), after = Json::object();
  for (const BeforeAfter& e : errors) {
    before[e.before.rows] = json_of(e.before.coverage);
    after[e.after.rows] = json_of(e.after.coverage);
  }
  return {{"before", before}, {"after", after}};
}

Json tail_json(std::span<const BeforeAfter> errors) {
  Json json{{"observable", "runout"},
            {"beyond_m", json_of(errors.empty() ? kNotGiven : errors.front().after.tail_begin)}};
  for (const BeforeAfter& e : errors)
    json[e.after.rows] = {{"before", json_of(e.before.tail.total)},
                          {"after", json_of(e.after.tail.total)},
                          {"reduction", json_of(e.tail_reduction.share)},
                          {"ci95", json_of(e.tail_reduction.interval)},
                          {"climatology", json_of(e.after.tail_climatology.total)},
                          {"skill", json_of(e.after.tail_skill.share)},
                          {"skill_ci95", json_of(e.after.tail_skill.interval)},
                          {"rows", e.after.tail.rows.size()}};
  return json;
}

Json judged_json(const JudgedModel& model, const JudgedModel& reference, std::span<const std::uint32_t> clusters) {
  Json groups = Json::array();
  const std::vector<GroupScore>& logs = model.log_score.groups;  // none of mapped blocks
  for (std::size_t g = 0; g < model.score.groups.size(); ++g)
    groups.push_back({{"group", model.score.groups[g].name},
                      {"error", json_of(model.score.groups[g].score)},
                      {"log_score", json_of(g < logs.size() ? -logs[g].score : kNotGiven)},
                      {"rows", model.score.groups[g].rows},
                      {"rows_as_climatology", model.score.groups[g].unseen}});
  const Reduction less = reduction(reference.score, model.score, clusters);
  const NatsGained nats = nats_gained(reference.log_score, model.log_score, clusters);
  return {{"error", json_of(model.score.total)},      {"reduction", json_of(less.share)},
          {"reduction_ci95", json_of(less.interval)}, {"log_score", json_of(-model.log_score.total)},
          {"nats_gained", json_of(nats.per_block)},   {"nats_gained_ci95", json_of(nats.interval)},
          {"rows", model.score.rows.size()},          {"groups", groups}};
}

Json evidence_json(std::span<const BeforeAfter> errors, std::span<const std::uint32_t> clusters, const char* before,
                   const char* after) {
  return Json::array({entry_of("climatology", errors, clusters, of_climatology),
                      entry_of(before, errors, clusters, of_before), entry_of(after, errors, clusters, of_after)});
}

std::string tail_before_after(const BeforeAfter& e) {
  if (e.after.tail.groups.empty()) return {};
  if (hardly_simulated(e.before.tail) || hardly_simulated(e.after.tail)) return tail_sentence(e.after) + ".";
  return "Run-out beyond " + with_digits(e.after.tail_begin, 3) + " m, " + rows_in_words(e.after.rows) +
         " rows: error " + score_text(e.before.tail.total) + " before, " + score_text(e.after.tail.total) +
         " after (lower by " + tenths_of_percent(e.tail_reduction.share) +
         " %, 95 %: " + tenths_of_percent(e.tail_reduction.interval.low) + " to " +
         tenths_of_percent(e.tail_reduction.interval.high) + " %); then " + tail_against_climatology(e.after) + ".";
}

std::string interval_text(const Interval& interval, double unit, int decimals) {
  return with_decimals(unit * interval.low, decimals) + " to " + with_decimals(unit * interval.high, decimals);
}

std::string unit_text(const std::string& unit) {
  return unit.empty() || unit == "1" ? "" : " " + unit;
}

std::string score_text(double score) {
  return std::isnan(score) ? "-" : with_decimals(score, 3);
}

std::string gain_text(double gain, const Interval& interval) {
  if (std::isnan(gain)) return "";
  return with_decimals(gain, 3) + " (" + interval_text(interval, 1.0, 3) + ")";
}

std::string judgement_markdown(const BeforeAfter& e, const std::string& ranks) {
  std::string text;
  for (const std::string& sentence :
       {skill_sentence(e.after), runout_side(e.after), tail_before_after(e), leaving_sentence(e.after)})
    if (!sentence.empty()) text += sentence + (sentence.ends_with('.') ? "" : ".") + "\n\n";
  for (const std::string& sentence : deposit_sentences(e.after)) text += sentence + ".\n\n";
  if (e.after.coverage.empty()) return text;
  return text +
         "Measured values below the simulated P5, P50 and P95, after the fit (in brackets 95 % of right models; *: "
         "hardly a right model); the ranks are drawn in `" +
         ranks + "`:\n\n" + coverage_markdown(e.after.coverage) + "\n";
}

Markup groups_html(const BeforeAfter& e) {
  Markup html = "<table><tr><th>group, "_html + rows_in_words(e.after.rows) +
                " rows</th><th>before</th><th>after</th><th>climatology</th><th>rows</th></tr>\n";
  for (std::size_t g = 0; g < e.after.score.groups.size(); ++g) {
    const GroupScore& group = e.after.score.groups[g];
    html += "<tr><td>"_html + group.name + "</td><td>" + score_text(e.before.score.groups[g].score) + "</td><td>" +
            score_text(group.score) + "</td><td>" + score_text(e.after.climatology.groups[g].score) + "</td><td>" +
            rows_text(group) + "</td></tr>\n";
  }
  return html + "<tr><td><b>mean</b></td><td>" + score_text(e.before.score.total) + "</td><td>" +
         score_text(e.after.score.total) + "</td><td>" + score_text(e.after.climatology.total) + "</td><td>" +
         std::to_string(e.after.score.rows.size()) + "</td></tr></table>\n";
}

}  // namespace talus::io
