#include "diagnosis_parts.hpp"

namespace talus::io {

Json family_json(const FamilyTest& family) {
  Json parts = Json::array();
  for (const FamilyPart& part : family.parts)
    parts.push_back({{"name", part.name},
                     {"statistic", part.statistic},
                     {"value", json_of(part.value)},
                     {"p_value", json_of(part.p_value)}});
  return {{"name", family.name},
          {"p_value", json_of(family.p_value)},
          {"p_corrected", json_of(family.p_corrected)},
          {"members", family.members},
          {"may_name", family.may_name},
          {"note", family.note},
          {"parts", parts}};
}

Json effect_json(const FittedEffect& effect) {
  Json parameters = Json::object();
  for (std::size_t i = 0; i < effect.values.size(); ++i)
    parameters[effect.parameters[i].key] = json_of(effect.values[i]);
  return {{"effect", effect.effect},
          {"where", effect.where},
          {"parameters", parameters},
          {"price", json_of(effect.price)},
          {"objective_gain", json_of(effect.gain)},
          {"objective_gain_ci95", json_of(effect.gain_interval)},
          {"cross_validated_objective_gain", json_of(effect.cross_validated)},
          {"cross_validated_objective_gain_ci95", json_of(effect.cross_validated_interval)},
          {"unseen_gain", json_of(effect.unseen_gain())},
          {"unseen_gain_ci95", json_of(effect.unseen_gain_interval())},
          {"confirmed_objective_gain", json_of(effect.confirmation.fitted)},
          {"confirmed_unseen_gain", json_of(effect.confirmation.unseen)},
          {"chosen_share", json_of(effect.chosen_share)}};
}

Json trials_json(const TrialsPerBlock& trials) {
  return {{"search", trials.search}, {"test", trials.test}, {"compare", trials.compare}};
}

}  // namespace talus::io
