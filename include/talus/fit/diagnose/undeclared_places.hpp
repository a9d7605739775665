#pragma once
#include "talus/fit/diagnose/axis.hpp"
#include "talus/fit/diagnose/candidate.hpp"

/// Candidates for objects that a campaign does not declare: other ground in a band, a barrier.
/// docs/diagnosis-method.md, "The candidates".
namespace talus {

/// A band of other ground across the axis, from one distance along it to another [m].
Candidate band(const Campaign& campaign, const Axis& axis, double from, double to);
/// A barrier across the axis that takes any energy, at a distance along it.
///
/// @param width  half of its length [m]
Candidate barrier(const Axis& axis, double width, double at);

}  // namespace talus
