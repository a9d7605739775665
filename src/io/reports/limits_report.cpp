#include "limits_report.hpp"

#include <cmath>

#include "evidence.hpp"
#include "talus/base/text.hpp"
#include "talus/io/reports/diagnosis_report.hpp"

namespace talus::io {
namespace {

/// @param none  what stands for an amount that there is not
std::string amount_text(const DetectionLimit& limit, double amount, const char* none = "not to be seen") {
  if (std::isnan(amount)) return none;
  return with_digits(amount, 2) + unit_text(limit.unit);
}

}  // namespace

Json limits_json(std::span<const DetectionLimit> limits, bool further) {
  Json list = Json::array();
  for (const DetectionLimit& limit : limits) {
    Json places = Json::array();
    for (const auto& [where, amount] : limit.places) places.push_back({{"where", where}, {"amount", json_of(amount)}});
    list.push_back({{"effect", limit.effect},
                    {"where", limit.where},
                    {"parameter", limit.key},
                    {"amount", json_of(limit.amount)},
                    {"unit", limit.unit},
                    {"off", json_of(limit.off)},
                    {"places", places}});
    if (further) list.back()["amount_with_further_speeds"] = json_of(limit.with_further_speeds);
  }
  return list;
}

Markup limits_html(std::span<const DetectionLimit> limits) {
  Markup html =
      "<table><tr><th>effect</th><th>where it would be seen best</th><th>parameter</th><th>without it</th><th>would be "
      "seen from</th><th>with speeds at 12 further screens</th></tr>\n"_html;
  for (const DetectionLimit& limit : limits)
    html += "<tr><td>"_html + limit.effect + "</td><td>" + limit.where + "</td><td>" + limit.key + "</td><td>" +
            amount_text(limit, limit.off, "-") + "</td><td>" + amount_text(limit, limit.amount) + "</td><td>" +
            amount_text(limit, limit.with_further_speeds) + "</td></tr>\n";
  return html + "</table>\n";
}

std::string limits_lines(std::span<const DetectionLimit> limits) {
  std::string hidden, helped;
  for (const DetectionLimit& limit : limits) {
    if (!std::isnan(limit.amount)) continue;
    std::string& list = std::isnan(limit.with_further_speeds) ? hidden : helped;
    list += (list.empty() ? "" : ", ") + limit.effect;
  }
  std::string line;
  if (!hidden.empty()) line += "cannot be seen in these data: " + hidden + "\n";
  if (!helped.empty()) line += "speeds at more screens would show: " + helped + "\n";
  return line;
}

}  // namespace talus::io
