#include "talus/io/results/weighting_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "io/files/checksum.hpp"
#include "io/scenario/frequency_keys.hpp"
#include "talus/base/error.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/frequency.hpp"

namespace talus::io {
namespace {

constexpr std::string_view kNumberForm = "FID ";

/// "FID 3".
std::string number_form(const SourceFeature& feature) {
  return std::string(kNumberForm) + std::to_string(feature.id);
}

/// Whether a word is "FID " and a number; "FID north" is a name.
bool is_number_form(const std::string& word) {
  return word.starts_with(kNumberForm) && word.size() > kNumberForm.size() &&
         word.find_first_not_of("0123456789", kNumberForm.size()) == std::string::npos;
}

/// The features that a word of the file means: "FID 3" the one of this number, any other word those of this name or
/// number.
class FeaturesByWord {
 public:
  explicit FeaturesByWord(const std::vector<SourceFeature>& features) {
    for (std::size_t i = 0; i < features.size(); ++i) {
      const std::string number = std::to_string(features[i].id);
      by_word_[number_form(features[i])].push_back(i);
      by_word_[number].push_back(i);
      if (features[i].name != number && !is_number_form(features[i].name)) by_word_[features[i].name].push_back(i);
    }
  }

  std::vector<std::size_t> meant_by(const std::string& word) const {
    const auto found = by_word_.find(word);
    return found == by_word_.end() ? std::vector<std::size_t>{} : found->second;
  }

 private:
  std::unordered_map<std::string, std::vector<std::size_t>> by_word_;
};

/// Why a word that means several features is refused.
std::string ambiguous_text(const std::string& word, const std::vector<std::size_t>& found,
                           const std::vector<SourceFeature>& features) {
  std::vector<std::string> forms;
  for (const std::size_t i : found) forms.push_back('"' + number_form(features[i]) + '"');
  const bool names = std::ranges::all_of(found, [&](std::size_t i) { return features[i].name == word; });
  return (names ? std::to_string(found.size()) + " features are called " + word
                : word + " means " + std::to_string(found.size()) + " features, by name and by number") +
         ", must be one: name them as " + listed(forms);
}

/// Which features have a source cell in the run.
std::vector<bool> releasing(const Scenario& scenario) {
  std::vector<bool> releases(scenario.features.size());
  for (const SourceCell& cell : scenario.sources) releases[cell.feature] = true;
  return releases;
}

bool says_how_often(const FrequencyRules& rules) {
  return !std::isnan(rules.total) || !std::isnan(rules.per_area) || !std::isnan(rules.scale);
}

/// Whether the frequencies are those of the features. A field of zeros counts as not given.
bool is_by_features(const Scenario& scenario) {
  return std::ranges::any_of(scenario.features, [](const SourceFeature& f) { return f.frequency > 0.0; });
}

/// Takes other rules in place of all frequencies. The division over cells stays, and without another power law the
/// classes of blocks keep their shares of the events: the shares drawn may be quite different.
void replace_frequencies(Scenario& scenario, const FrequencyRules& given) {
  const std::vector<double> by_class = class_frequencies(scenario);
  const bool by_true_area = scenario.frequency.by_true_area;
  std::vector<BlockClass>& classes = scenario.blocks.classes;
  scenario.frequency = given;
  scenario.frequency.by_true_area = by_true_area;
  scenario.frequency.class_shares = std::isnan(given.scale) && by_class.size() > 1;
  for (SourceFeature& feature : scenario.features) feature.frequency = kNotGiven;
  for (std::size_t c = 0; c < classes.size(); ++c)
    classes[c].frequency = scenario.frequency.class_shares ? by_class[c] : kNotGiven;
}

/// Shares of the events that the classes of blocks keep; empty if they keep none.
std::vector<double> kept_shares(const Scenario& scenario) {
  std::vector<double> shares;
  if (!scenario.frequency.class_shares) return shares;
  double sum = 0.0;
  for (const BlockClass& block : scenario.blocks.classes) sum += block.frequency;
  for (const BlockClass& block : scenario.blocks.classes) shares.push_back(block.frequency / sum);
  return shares;
}

/// Throws InputError if a feature that releases blocks has no frequency.
void require_all_features(const Scenario& scenario, const std::string& file) {
  std::set<std::size_t> missing;
  for (const SourceCell& cell : scenario.sources)
    if (std::isnan(scenario.features[cell.feature].frequency)) missing.insert(cell.feature);
  std::vector<std::string> names;
  for (const std::size_t i : missing) {
    const SourceFeature& feature = scenario.features[i];
    names.push_back(feature.name.empty() ? std::to_string(feature.id) : feature.name);
  }
  if (!names.empty())
    throw InputError(
        file + ": [features] does not list " + listed(names) +
        ", must list every feature that releases blocks: the frequencies of the run are not by feature, so that "
        "none can stay");
}

/// Reads the frequencies of features. Adds what is given to `read`.
void read_features(TableReader& table, Scenario& scenario, GivenFrequencies& read) {
  if (table.value() == nullptr) return;
  std::vector<SourceFeature>& features = scenario.features;
  const FeaturesByWord by_word(features);
  const std::vector<bool> releases = releasing(scenario);
  std::vector<std::string> known, given(features.size());  // given: the word that meant the feature
  for (const SourceFeature& feature : features) known.push_back(feature.name);
  for (const auto& [word, value] : table.value()->members) {
    const std::vector<std::size_t> found = by_word.meant_by(word);
    if (found.empty())
      table.fault(word, value, "there is no such feature" + known_names(word, known));
    else if (found.size() > 1)
      table.fault(word, value, ambiguous_text(word, found, features));
    else if (!releases[found.front()])
      table.fault(word, value,
                  number_form(features[found.front()]) +
                      " releases nothing in the run (it lies off the DEM or where that has no heights, or has no "
                      "geometry), so that its events per year would be lost: leave it out, or mend the DEM or the "
                      "source and run again");
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
  TableReader features = top.table("features");
  const FrequencyRules& given = spec.values.frequency;
  const bool of_features = features.value() != nullptr && !features.value()->members.empty();
  const bool not_by_features = !is_by_features(scenario);
  GivenFrequencies read{file, sha256_of_file(file), given, {}, {}, {}};
  if (of_features && says_how_often(given))
    throw InputError(file +
                     ": [features] cannot be given with total, per_area or power_law of [frequency]: leave out one");
  if (says_how_often(given) || (of_features && not_by_features)) replace_frequencies(scenario, given);
  const bool says_area = spec.origins.contains("frequency.by_true_area");
  if (says_area) scenario.frequency.by_true_area = given.by_true_area;  // else that of the run stays
  if (says_area || scenario.frequency.by_true_area) read.by_true_area = scenario.frequency.by_true_area;
  read_features(features, scenario, read);
  top.finish();
  if (!faults.empty()) throw InputFaults(faults, faults.size());
  if (of_features && not_by_features) require_all_features(scenario, file);
  if (!AnnualWeights::of(scenario))
    throw InputError(file + ": no blocks fall with these frequencies; give one above 0");
  read.class_shares = kept_shares(scenario);
  read.warnings = frequency_warnings(scenario);
  return read;
}

std::string class_shares_text(const GivenFrequencies& given) {
  if (given.class_shares.empty()) return {};
  std::vector<std::string> percents;
  for (const double share : given.class_shares) percents.push_back(percent(share, 2));
  return "the classes of blocks keep their shares of the events: " + joined(percents);
}

}  // namespace talus::io
