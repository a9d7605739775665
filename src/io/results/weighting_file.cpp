#include "talus/io/results/weighting_file.hpp"

#include <algorithm>
#include <cmath>

#include "io/scenario/frequency_keys.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

/// Reads the frequencies of features. The file names a feature by its name or, without one, by its number (FID).
void read_features(TableReader& table, Scenario& scenario) {
  if (table.value() == nullptr) return;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < scenario.features.size(); ++i) {
    SourceFeature& feature = scenario.features[i];
    known.push_back(feature.name.empty() ? std::to_string(i) : feature.name);
    if (const auto value = table.number(known.back(), bounds_of("sources.frequency"))) feature.frequency = *value;
  }
  for (const auto& [name, value] : table.value()->members)
    if (std::find(known.begin(), known.end(), name) == known.end())
      table.fault(name, value, "there is no such feature" + known_names(name, known));
}

}  // namespace

void apply_weighting(const std::string& file, Scenario& scenario) {
  const TomlValue root = read_toml(file, file);
  std::vector<std::string> faults;
  TableReader top(&root, "", file, faults);
  ScenarioSpec spec;
  read_frequency(spec, top.table("frequency"), file);
  const FrequencyRules& given = spec.values.frequency;
  if (!std::isnan(given.total) || !std::isnan(given.per_area) || !std::isnan(given.scale)) {
    scenario.frequency = {};
    for (SourceFeature& feature : scenario.features) feature.frequency = kNotGiven;
    for (BlockClass& block : scenario.blocks.classes) block.frequency = kNotGiven;
    scenario.frequency = given;
  }
  if (spec.origins.contains("frequency.by_true_area")) scenario.frequency.by_true_area = given.by_true_area;
  TableReader features = top.table("features");
  read_features(features, scenario);
  top.finish();
  if (!faults.empty()) throw InputError(faults.front());
}

}  // namespace talus::io
