#include "talus/fit/diagnose/detection_limits.hpp"

#include <algorithm>
#include <cmath>

#include "talus/fit/diagnose/candidates.hpp"
#include "talus/fit/diagnose/families.hpp"

namespace talus {
namespace {

/// Value of a parameter at z; NaN beyond its bounds.
double within_bounds(const Parameter& parameter, double z) {
  const double value = parameter.value(z);
  return value > parameter.lower && value < parameter.upper ? value : kNotGiven;
}

DetectionLimit limit_of(const std::string& effect, const Candidate& candidate, const Precision& precision,
                        const DiagnosisRules& rules) {
  const Parameter& parameter = candidate.parameters[precision.parameter];
  const double z = rules.shown * rules.noticed * precision.standard_error;
  return {.effect = effect,
          .where = candidate.where,
          .key = parameter.key,
          .unit = parameter.unit,
          .off = parameter.value(0.0),
          .amount = within_bounds(parameter, z)};
}

/// The amounts of one parameter at all places of an effect.
std::vector<DetectionLimit::Place> amounts_by_place(const EffectVerdict& effect, const std::string& key,
                                                    std::span<const Candidate> candidates,
                                                    const DiagnosisRules& rules) {
  std::vector<DetectionLimit::Place> places;
  for (const Precision& precision : effect.places) {
    const DetectionLimit limit = limit_of(effect.effect, candidates[precision.members.front()], precision, rules);
    if (limit.key == key) places.push_back({limit.where, limit.amount});
  }
  return places;
}

}  // namespace

std::vector<DetectionLimit> limits_by_parameter(const Campaign& campaign, const Axis& axis, const ScoreTest& test,
                                                std::span<const Candidate> candidates, const DiagnosisRules& rules) {
  std::vector<DetectionLimit> limits;
  for (const EffectVerdict& effect : test.effects)
    for (const auto& [key, sharpest] : effect.sharpest)
      if (!sharpest.members.empty())
        limits.push_back(limit_of(effect.effect, merged_candidate(campaign, axis, candidates, sharpest.members, rules),
                                  sharpest, rules));
  return limits;
}

std::vector<DetectionLimit> detection_limits(const Campaign& campaign, const Axis& axis, const ScoreTest& test,
                                             std::span<const Candidate> candidates, const DiagnosisRules& rules) {
  std::vector<DetectionLimit> limits;
  for (const EffectVerdict& effect : test.effects) {
    std::vector<std::pair<double, DetectionLimit>> found;  // by parameter, with its standard error
    for (const auto& [key, sharpest] : effect.sharpest)
      if (!sharpest.members.empty())
        found.emplace_back(
            sharpest.standard_error,
            limit_of(effect.effect, merged_candidate(campaign, axis, candidates, sharpest.members, rules), sharpest,
                     rules));
    const auto best = std::ranges::min_element(found, {}, [](const auto& of_parameter) {
      return std::pair(std::isnan(of_parameter.second.amount), of_parameter.first);
    });
    if (best == found.end()) continue;
    limits.push_back(best->second);
    limits.back().places = amounts_by_place(effect, best->second.key, candidates, rules);
  }
  return limits;
}

Campaign with_further_screens(const Campaign& campaign, const Axis& axis, const DiagnosisRules& rules) {
  Campaign more = campaign;
  const Eigen::Vector2d across(-axis.direction.y(), axis.direction.x());
  const double length = axis.to - axis.from;
  for (int i = 1; i <= rules.further_screens; ++i) {
    const double at = axis.from + length * i / (rules.further_screens + 1);
    const Eigen::Vector2d middle = axis.origin + at * axis.direction;
    more.screens.push_back({"further " + std::to_string(i), {{middle - length * across, middle + length * across}}});
  }
  for (MeasuredBlock& block : more.blocks) {
    block.passages.resize(campaign.screens.size());
    block.passages.resize(more.screens.size(), Passage{.speed = 1.0});
  }
  return more;
}

void compare_limits(std::vector<DetectionLimit>& limits, std::span<const DetectionLimit> further) {
  for (DetectionLimit& limit : limits) {
    const auto same = std::ranges::find_if(
        further, [&](const DetectionLimit& f) { return f.effect == limit.effect && f.key == limit.key; });
    if (same != further.end()) limit.with_further_speeds = same->amount;
  }
}

void complete_limits(std::vector<DetectionLimit>& limits, std::span<const FamilyTest> families,
                     std::span<const std::string> found) {
  for (DetectionLimit& limit : limits) {
    if (can_be_named(families, limit.effect)) continue;
    limit.amount = limit.with_further_speeds = kNotGiven;
    for (DetectionLimit::Place& place : limit.places) place.amount = kNotGiven;
  }
  for (const std::string& name : sought_names())
    if (std::ranges::find(found, name) == found.end() &&
        std::ranges::find(limits, name, &DetectionLimit::effect) == limits.end())
      limits.push_back({.effect = name, .off = kNotGiven});
}

}  // namespace talus
