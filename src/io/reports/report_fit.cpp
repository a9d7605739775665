#include "report_fit.hpp"

#include <cmath>
#include <utility>

#include "evidence.hpp"
#include "io/files/checksum.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"
#include "talus/io/reports/fit_report.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

void read_errors(const Json& json, FitPart& part) {
  const Json error = json.value("error", Json::object());
  for (const auto& [key, rows] : {std::pair("fit", "fitting rows"), {"holdout", "rows that were held out"}}) {
    const Json one = error.value(key, Json());
    if (!one.is_object() || !one.contains("before") || one.at("before").is_null()) continue;
    part.errors.push_back({rows, number_of(one, "before"), number_of(one, "after")});
  }
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
  const InputFile* const model = run.input("include");
  if (model == nullptr) return std::nullopt;
  FitPart part;
  part.file = model->path;
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
    part = {part.file, {}, "Its record cannot be read: " + shortened(error.what(), 300), {}, {}, {}, {}};
  }
  return part;
}

Markup fit_html(const std::optional<FitPart>& part) {
  if (!part) return {};
  Markup html = "<h2>Fit of the ground</h2>\n<p>The scenario includes "_html + part->file +
                (part->campaign.empty() ? std::string() : ", fitted to the campaign " + part->campaign) + ".</p>\n";
  if (!part->note.empty()) return html + "<p class='look'>" + part->note + "</p>\n";
  if (!part->errors.empty()) {
    html += "<table><tr><th>error (mean normalised score)</th><th>before</th><th>after</th></tr>\n";
    for (const FitPart::Error& error : part->errors)
      html += "<tr><td>"_html + error.rows + "</td><td class='n'>" + score_text(error.before) + "</td><td class='n'>" +
              score_text(error.after) + "</td></tr>\n";
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
