#pragma once
#include "talus/fit/diagnose/axis.hpp"
#include "talus/fit/diagnose/detection_limit.hpp"
#include "talus/fit/diagnose/family_test.hpp"
#include "talus/fit/diagnose/score_test.hpp"

namespace talus {

/// The limit of every tested effect, in the order of the test: of the parameter and place that are measured best.
std::vector<DetectionLimit> detection_limits(const Campaign& campaign, const Axis& axis, const ScoreTest& test,
                                             std::span<const Candidate> candidates, const DiagnosisRules& rules);

/// The limits of all parameters of each effect, each at the place where it is measured best.
std::vector<DetectionLimit> limits_by_parameter(const Campaign& campaign, const Axis& axis, const ScoreTest& test,
                                                std::span<const Candidate> candidates, const DiagnosisRules& rules);

/// The campaign as it would be if speeds were also measured at `rules.further_screens` lines across its axis, at equal
/// distances from the release to where the paths end. The speeds themselves have no meaning: it is for limits only.
Campaign with_further_screens(const Campaign& campaign, const Axis& axis, const DiagnosisRules& rules);

/// Adds the limits that `further` measurements would give, of the same parameter of each effect.
///
/// @param further  by parameter: which one is measured best may be another one with further measurements
void compare_limits(std::vector<DetectionLimit>& limits, std::span<const DetectionLimit> further);

/// Completes a list of limits: no amount is seen of an effect that no family can name, and effects that nothing
/// measured could show, which have no candidate, follow at the end, without a parameter.
///
/// @param families  tests of the model of the limits
/// @param found     effects that this model has
void complete_limits(std::vector<DetectionLimit>& limits, std::span<const FamilyTest> families,
                     std::span<const std::string> found);

}  // namespace talus
