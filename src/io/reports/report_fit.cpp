#include "report_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evidence.hpp"
#include "io/files/checksum.hpp"
#include "io/scenario/fitted_on.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"
#include "talus/io/reports/fit_report.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

/// The error of the climatology: beside those of a calibration, a model of its own in the evidence of a diagnosis.
double climatology_of(const Json& json, const Json& error, const char* rows) {
  if (error.contains("climatology")) return number_of(error, "climatology", kNotGiven);
  for (const Json& model : json.value("evidence", Json::array()))
    if (model.value("model", "") == "climatology")
      return number_of(model.value(rows, Json::object()), "error", kNotGiven);
  return kNotGiven;
}

void read_errors(const Json& json, FitPart& part) {
  const Json error = json.value("error", Json::object());
  for (const auto& [key, rows] : {std::pair("fit", "fitting rows"), {"holdout", "rows that were held out"}}) {
    const Json one = error.value(key, Json());
    if (!one.is_object() || !one.contains("before") || one.at("before").is_null()) continue;
    const std::string kind = one.value("rows", key);  // of a diagnosis the unseen rows may be those out of their folds
    part.errors.push_back(
        {rows, number_of(one, "before"), number_of(one, "after"), climatology_of(json, one, kind.c_str())});
  }
}

/// The skill that the file of the model gives, as the run has read it.
Reduction skill_in(const RunFacts& run) {
  for (const RecordedSetting* setting : run.settings_of("fit.fitted_skill")) {
    const Json list = Json::parse(setting->value, nullptr, false);
    if (!list.is_array() || !std::ranges::all_of(list, [](const Json& one) { return one.is_number(); })) continue;
    if (const auto skill = skill_of_list(list.get<std::vector<double>>())) return *skill;
  }
  return {};
}

void read_calibration(const Json& json, FitPart& part) {
  part.campaign = json.value("campaign", "");
  for (const Json& one : json.value("parameters", Json::array())) {
    FitPart::Number number{one.at("key").get<std::string>(), one.value("unit", ""), number_of(one, "value")};
    if (const Json bounds = one.value("ci95", Json()); bounds.is_array() && bounds.size() == 2 && bounds[0].is_number())
      number.low = bounds[0].get<double>(), number.high = bounds[1].get<double>();
    number.identifiable = one.value("identifiable", true);
    number.at_bound = one.value("at_bound", false);
    part.parameters.push_back(std::move(number));
  }
  read_errors(json, part);
  part.warnings = texts_of(json, "warnings");
}

void read_diagnosis(const Json& json, FitPart& part) {
  if (part.campaign.empty()) part.campaign = json.value("campaign", "");
  const bool ground_alone = fs::path(part.file).filename() == "fitted.toml";  // beside with_effect.toml
  const std::string first = json.value("effect", ""), where = json.value("where", "");
  part.effect = json.value("verdict", first);
  if (const std::vector<std::string> effects = texts_of(json, "effects"); part.effect == first && effects.size() > 1)
    part.effect = joined(effects);
  else if (!where.empty())
    part.effect += ", " + where;
  if (ground_alone && names_effect(first)) part.effect += "; this file is the ground alone, without it";
  if (part.errors.empty()) {
    read_errors(json, part);
    if (ground_alone)
      for (FitPart::Error& error : part.errors) error.after = std::exchange(error.before, kNotGiven);
  }
  for (std::string& warning : texts_of(json, "warnings")) part.warnings.push_back(std::move(warning));
}

}  // namespace

std::optional<FitPart> read_fit_part(const RunFacts& run) {
  const InputFile* const model = run.input(kFittedModel);
  if (model == nullptr || !run.fitted_ground) return std::nullopt;
  FitPart part;
  part.file = model->path;
  part.skill = skill_in(run);
  try {
    if (sha256_of_file(model->path) != model->sha256) {
      part.note = "The file has changed since the run, or is no longer there: its fit is not shown.";
      return part;
    }
    const fs::path folder = fs::path(model->path).parent_path();
    bool found = false;
    for (const auto read : {&read_calibration, &read_diagnosis}) {
      const fs::path record = folder / (read == &read_calibration ? "calibration.json" : "diagnosis.json");
      if (!fs::exists(record)) continue;
      found = true;
      understood(record, [&](const Json& json) {
        read(json, part);
        return true;
      });
    }
    if (!found) part.note = "There is no record of a fit beside it (calibration.json, diagnosis.json).";
  } catch (const InputError& error) {
    FitPart unread;
    unread.file = part.file;
    unread.skill = part.skill;
    unread.note = "Its record cannot be read: " + shortened(error.what(), 300);
    return unread;
  }
  return part;
}

std::string FitPart::not_identifiable() const {
  const auto unknown = std::ranges::count(parameters, false, &Number::identifiable);
  if (unknown == 0) return {};
  return std::to_string(unknown) + " of " + std::to_string(parameters.size()) +
         (unknown == 1 ? " fitted numbers is" : " fitted numbers are") + " not identifiable";
}

std::string skill_of_fit_text(const Reduction& skill) {
  if (std::isnan(skill.share))
    return "its skill is not known: the file of the model gives none (that of mapped deposits, or of an earlier "
           "version)";
  if (!(skill.share > 0.0)) return "no skill: " + reduction_in_words(skill);
  return "skill " + reduction_in_words(skill) + (skill.interval.low > 0.0 ? "" : ": it may have none");
}

Markup fit_html(const std::optional<FitPart>& part) {
  if (!part) return {};
  Markup html = "<h2>Fit of the ground</h2>\n<p>The scenario includes "_html + part->file +
                (part->campaign.empty() ? std::string() : ", fitted to the campaign " + part->campaign) + ".</p>\n";
  html += "<p>Against the climatology, the measurements of the other blocks without any model: <b>"_html +
          skill_of_fit_text(part->skill) + "</b>.</p>\n";
  if (!part->note.empty()) return html + "<p class='look'>" + part->note + "</p>\n";
  if (!part->errors.empty()) {
    html +=
        "<table><tr><th>error (mean normalised score)</th><th>before</th><th>after</th>"
        "<th>climatology</th></tr>\n";
    for (const FitPart::Error& error : part->errors)
      html += "<tr><td>"_html + error.rows + "</td><td class='n'>" + score_text(error.before) + "</td><td class='n'>" +
              score_text(error.after) + "</td><td class='n'>" + score_text(error.climatology) + "</td></tr>\n";
    html += "</table>\n";
  }
  if (!part->effect.empty()) html += "<p>The diagnosis found: <b>"_html + part->effect + "</b>.</p>\n";
  if (!part->parameters.empty()) {
    html += "<table><tr><th>parameter</th><th>value</th><th>95 % interval</th><th></th></tr>\n";
    for (const FitPart::Number& number : part->parameters)
      html += "<tr><td>"_html + number.key + "</td><td class='n'>" + with_digits(number.value, 3) + " " + number.unit +
              "</td><td class='n'>" + with_digits(number.low, 3) + " to " + with_digits(number.high, 3) + "</td><td>" +
              interval_note(number.identifiable, number.at_bound) + "</td></tr>\n";
    html += "</table>\n";
  }
  for (const std::string& warning : part->warnings) html += "<p class='look'>Warning: "_html + warning + "</p>\n";
  return html;
}

}  // namespace talus::io
