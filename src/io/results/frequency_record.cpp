#include "frequency_record.hpp"

#include <cmath>

namespace talus::io {

Json json_of(const GivenFrequencies& frequencies, double events_per_year) {
  const FrequencyRules& rules = frequencies.rules;
  Json general = Json::object(), features = Json::object();
  if (frequencies.by_true_area) general["by_true_area"] = *frequencies.by_true_area;
  if (!std::isnan(rules.total)) general["total"] = rules.total;
  if (!std::isnan(rules.per_area)) general["per_area"] = rules.per_area;
  if (!std::isnan(rules.scale)) general["power_law"] = {{"A", rules.scale}, {"b", rules.exponent}};
  for (const auto& [feature, frequency] : frequencies.features) features[feature] = frequency;
  Json record{{"file", frequencies.file},
              {"sha256", frequencies.sha256},
              {"given", {{"frequency", general}, {"features", features}}},
              {"events_per_year", events_per_year}};
  if (!frequencies.class_shares.empty()) record["class_shares"] = frequencies.class_shares;
  return record;
}

}  // namespace talus::io
