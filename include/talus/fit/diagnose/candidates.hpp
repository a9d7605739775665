#pragma once
#include "talus/fit/calibrate/calibrate.hpp"

namespace talus {

/// The amount of an effect that one would notice, in z: what the score test moves. The prior is four times as wide.
inline constexpr double kNoticed = 0.25;

/// Something that may be missing in a model: where it acts and the numbers that it adds. Off, at z = 0 of all its
/// parameters, it changes nothing. docs/closing-the-loop.md, "Candidates".
struct Candidate {
  std::string effect;                   ///< as in diagnosis.json: "vegetation-drag", ..., "instrument-bias"
  std::string where;                    ///< "everywhere", "zone meadow", "day 2", "screen S1 speed", "92 to 110 m"
  std::vector<Parameter> parameters;    ///< one or two; those that need no test of their own come last
  std::size_t tested = 1;               ///< how many of them the score test moves
  std::function<void(Model&)> prepare;  ///< before the parameters are set: places and lines
  double searched = 0.0;                ///< how many numbers of its place were chosen by the data: a price of its fit
  double from = 0.0, to = 0.0;          ///< of a band: along the axis [m]
  std::vector<int> days = {};           ///< of an effect that acts on days
};

struct Axis;

/// The effects of the registry, undeclared zones and barriers and the bias of instruments, with every place where they
/// may act.
///
/// @param runs     of the base model: says which zones are met and where the blocks go
/// @param without  names of effects that the base model has already
///
/// Candidates of one effect stand one after the other. Bands (undeclared-zone) are given as the cells of a ladder of
/// `kBands` along the axis, in order, wet days one by one: the score test joins them, as their signatures add up.
std::vector<Candidate> candidates_of(const Campaign& campaign, const Model& base, std::span<const BlockRuns> runs,
                                     std::span<const std::string> without);

inline constexpr int kBands = 12;  ///< of the ladder for undeclared zones
inline constexpr int kLines = 16;  ///< places of an undeclared barrier

/// The one candidate that several of one effect make: a band of neighbouring ones, or all of their days.
Candidate together(const Campaign& campaign, const Axis& axis, std::span<const Candidate> list,
                   std::span<const std::size_t> members);

/// The model with a candidate in place, at z of its parameters.
Model with(const Model& base, const Candidate& candidate, const Eigen::VectorXd& z);

}  // namespace talus
