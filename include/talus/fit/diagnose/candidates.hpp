#pragma once
#include "talus/fit/diagnose/axis.hpp"
#include "talus/fit/diagnose/candidate.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"

namespace talus {

/// The effects of the registry, undeclared zones and barriers and the bias of instruments, with every place where they
/// may act.
///
/// @param runs     of the base model: the zones that are met and the ways of the blocks follow from them
/// @param without  names of effects that the base model has already
///
/// Candidates of one effect stand one after the other. Bands (undeclared-zone) are given as the cells of a ladder of
/// `bands` along the axis, in order, wet days one by one: the score test joins them, because their signatures add up.
std::vector<Candidate> candidates_of(const Campaign& campaign, const Model& base, std::span<const BlockRuns> runs,
                                     std::span<const std::string> without, const DiagnosisRules& rules);

/// Names of all effects that are sought, in the order of their candidates: also of those that have no candidate,
/// because nothing was measured that could show them.
std::vector<std::string> sought_names();

/// Merges candidates of one effect into one: neighbouring bands, or days. Of any other effect the first is returned.
Candidate merged_candidate(const Campaign& campaign, const Axis& axis, std::span<const Candidate> list,
                           std::span<const std::size_t> members, const DiagnosisRules& rules);

/// The model with a candidate in place, at z of its parameters.
Model with(const Model& base, const Candidate& candidate, const Eigen::VectorXd& z);

}  // namespace talus
