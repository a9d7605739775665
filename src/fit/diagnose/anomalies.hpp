#pragma once
#include "talus/fit/diagnose/axis.hpp"
#include "talus/fit/diagnose/candidate.hpp"

namespace talus {

/// A parameter that is off at `off`, noticed at off + size, and searched on a linear scale. Its sd is `size`: what one
/// would notice is at z = 1 until `candidates_of` makes the prior wider.
Parameter amount(std::string key, std::string unit, double off, double size, double lower, double upper,
                 std::function<double(const Model&)> get, std::function<void(Model&, double)> set);

/// A band of other ground across the axis, from one distance along it to another [m].
Candidate band(const Campaign& campaign, const Axis& axis, double from, double to);
/// A net across the axis.
Candidate barrier(const Axis& axis, double width, double at);

/// Candidates for each quantity of each instrument that saw at least five blocks: it reads too high or too low.
void add_biases(std::vector<Candidate>& list, const Campaign& campaign);

}  // namespace talus
