#include "talus/io/results/weighting_file.hpp"

#include <cmath>

#include "io/files/checksum.hpp"
#include "io/scenario/frequency_keys.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

/// The features that a word of the file means: those of this name, else the one of this number (FID).
std::vector<std::size_t> meant_by(const std::string& word, const std::vector<SourceFeature>& features) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < features.size(); ++i)
    if (features[i].name == word) found.push_back(i);
  for (std::size_t i = 0; found.empty() && i < features.size(); ++i)
    if (std::to_string(features[i].id) == word) found.push_back(i);
  return found;
}

/// Reads the frequencies of features. Adds what is given to `read`.
void read_features(TableReader& table, Scenario& scenario, GivenFrequencies& read) {
  if (table.value() == nullptr) return;
  std::vector<SourceFeature>& features = scenario.features;
  std::vector<std::string> known, given(features.size());  // given: the word that meant the feature
  for (const SourceFeature& feature : features) known.push_back(feature.name);
  for (const auto& [word, value] : table.value()->members) {
    const std::vector<std::size_t> found = meant_by(word, features);
    std::vector<std::string> numbers;
    for (const std::size_t i : found) numbers.push_back(std::to_string(features[i].id));
    if (found.empty())
      table.fault(word, value, "there is no such feature" + known_names(word, known));
    else if (found.size() > 1)
      table.fault(word, value,
                  std::to_string(found.size()) + " features are called " + word + " (numbers " + joined(numbers) +
                      "), must be one: name them by number");
    else if (const std::string& earlier = given[found.front()]; !earlier.empty())
      table.fault(word, value, "is the feature " + earlier + ", which has a frequency here already");
    if (found.size() != 1) continue;
    given[found.front()] = word;
    const auto frequency = table.number(word, bounds_of("sources.frequency"));
    if (!frequency) continue;
    features[found.front()].frequency = *frequency;
    read.features.emplace_back(word, *frequency);
  }
}

}  // namespace

GivenFrequencies apply_weighting(const std::string& file, Scenario& scenario) {
  const TomlValue root = read_settings(file, file, "[frequency] or [features]");
  std::vector<std::string> faults;
  TableReader top(&root, "", file, faults);
  ScenarioSpec spec;
  read_frequency(spec, top.table("frequency"), file);
  const FrequencyRules& given = spec.values.frequency;
  GivenFrequencies read{file, sha256_of_file(file), given, {}, {}};
  if (!std::isnan(given.total) || !std::isnan(given.per_area) || !std::isnan(given.scale)) {
    scenario.frequency = {};
    for (SourceFeature& feature : scenario.features) feature.frequency = kNotGiven;
    for (BlockClass& block : scenario.blocks.classes) block.frequency = kNotGiven;
    scenario.frequency = given;
  }
  if (spec.origins.contains("frequency.by_true_area")) {
    read.by_true_area = given.by_true_area;
    scenario.frequency.by_true_area = given.by_true_area;
  }
  TableReader features = top.table("features");
  read_features(features, scenario, read);
  top.finish();
  if (!faults.empty()) throw InputError(faults.front());
  return read;
}

}  // namespace talus::io
