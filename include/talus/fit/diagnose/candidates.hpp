#pragma once
#include "talus/fit/calibrate/parameters.hpp"
#include "talus/fit/diagnose/axis.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"

namespace talus {

/// Something that may be missing in a model: where it acts and the numbers that it adds. Off, at z = 0 of all its
/// parameters, it changes nothing. docs/closing-the-loop.md, "The candidates".
struct Candidate {
  std::string effect;                   ///< as in diagnosis.json: "vegetation-drag", ..., "instrument-bias"
  std::string where;                    ///< "everywhere", "zone meadow", "day 2", "screen S1 speed", "92 to 110 m"
  std::vector<Parameter> parameters;    ///< one or two; those that need no test of their own come last
  std::size_t tested = 1;               ///< number of them that the score test moves
  std::function<void(Model&)> prepare;  ///< before the parameters are set: places and lines
  double searched = 0.0;                ///< numbers of its place that the data chose: each has a price
  double from = 0.0, to = 0.0;          ///< of a band: along the axis [m]
  std::vector<int> days = {};           ///< of wet ground
};

/// The effects of the library and the anomalies that are not physics, with every place where they may act.
///
/// @param runs     of the base model: says which zones are met and where the blocks go
/// @param without  names of effects that the base model has already
///
/// Candidates of one effect stand one after the other. Bands (undeclared-zone) are given as the cells of a ladder of
/// `bands` along the axis, in order, wet days one by one: the score test joins them, because their signatures add up.
std::vector<Candidate> candidates_of(const Campaign& campaign, const Model& base, std::span<const BlockRuns> runs,
                                     std::span<const std::string> without, const DiagnosisRules& rules = {});

/// Merges candidates of one effect into one: neighbouring bands, or days. Of any other effect the first is returned.
Candidate merged_candidate(const Campaign& campaign, const Axis& axis, std::span<const Candidate> list,
                           std::span<const std::size_t> members, const DiagnosisRules& rules = {});

/// The model with a candidate in place, at z of its parameters.
Model with(const Model& base, const Candidate& candidate, const Eigen::VectorXd& z);

}  // namespace talus
