#pragma once
#include "talus/fit/diagnose/candidates.hpp"

namespace talus {

/// A parameter that is off at `off`, noticed at off + size, and searched on a linear scale.
Parameter amount(std::string key, std::string unit, double off, double size, double lower, double upper,
                 std::function<double(const Model&)> get, std::function<void(Model&, double)> set);

/// Candidates for each quantity of each instrument that saw at least five blocks: it reads too high or too low.
void add_biases(std::vector<Candidate>& list, const Campaign& campaign);

}  // namespace talus
