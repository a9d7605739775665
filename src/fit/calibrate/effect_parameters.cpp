#include "talus/fit/calibrate/effect_parameters.hpp"

#include <algorithm>

#include "amount.hpp"
#include "talus/base/error.hpp"
#include "talus/base/sample.hpp"
#include "talus/base/text.hpp"

namespace talus {
namespace {

double median_of_fitting(const Campaign& campaign, const std::function<double(const MeasuredBlock&)>& value) {
  std::vector<double> values;
  for (const MeasuredBlock& block : campaign.blocks)
    if (!block.holdout) values.push_back(value(block));
  return median_of(std::move(values));
}

std::string full_key(const EffectField& field) {
  return "effects." + std::string(field.key);
}

/// The number of an effect with this key; throws InputError if there is none that a search may move.
std::pair<const EffectEntry*, const EffectField*> sought_number(const std::string& key) {
  std::vector<std::string> known;
  for (const EffectEntry& entry : effect_entries())
    for (const EffectField& field : entry.fields()) {
      if (!field.search) continue;
      if (full_key(field) == key) return {&entry, &field};
      known.push_back(full_key(field));
    }
  throw InputError("'" + key + "' is no number of an effect that can be fitted" + known_names(key, known));
}

}  // namespace

TypicalBlock typical_block(const Campaign& campaign) {
  return {median_of_fitting(campaign, [](const MeasuredBlock& b) { return b.mass; }),
          median_of_fitting(campaign, [](const MeasuredBlock& b) { return equivalent_diameter(b.mass, b.density); })};
}

Parameter effect_parameter(const EffectEntry& entry, const EffectField& field, const TypicalBlock& typical) {
  const SearchRange& range = *field.search;
  const std::string table = "effects." + std::string(entry.name) + ".", key(entry.key_of(field));
  if (!range.inverse_unit.empty())
    return amount(
        table + "1/" + key, std::string(range.inverse_unit), range,
        [get = field.get](const Model& m) {
          const double value = get(m.effects);
          return value > 0.0 ? 1.0 / value : 0.0;
        },
        [set = field.set, most = field.max](Model& m, double v) { set(m.effects, v * most > 1.0 ? 1.0 / v : 0.0); });
  const double scale = typical.of(range.times);
  const SearchRange scaled{.lower = std::max(field.min, range.lower * scale),
                           .upper = std::min(field.max, range.upper * scale),
                           .noticed = range.noticed * scale,
                           .off = range.off};
  return amount(
      table + key, std::string(field.unit), scaled, [get = field.get](const Model& m) { return get(m.effects); },
      [set = field.set](Model& m, double v) { set(m.effects, v); });
}

std::vector<Parameter> effect_parameters(const Campaign& campaign, const Model& start,
                                         std::span<const std::string> keys, double noticed) {
  std::vector<Parameter> parameters;
  for (const std::string& key : keys) {
    const auto [entry, field] = sought_number(key);
    if (std::ranges::count(keys, key) > 1) throw InputError("'" + key + "' is to be fitted twice: name it once");
    const std::vector<int>* days = entry->days(start.effects);
    if (days != nullptr && days->empty())
      throw InputError("'" + key + "': the model says no days on which it acts, must list them: days = [1, 2]");
    parameters.push_back(effect_parameter(*entry, *field, typical_block(campaign)));
    parameters.back().sd /= noticed;
  }
  return parameters;
}

}  // namespace talus
