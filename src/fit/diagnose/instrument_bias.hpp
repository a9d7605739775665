#pragma once
#include "talus/fit/diagnose/candidate.hpp"

namespace talus {

/// Adds a candidate for each quantity of each instrument that saw at least five blocks: the instrument reads too high
/// or too low.
void add_biases(std::vector<Candidate>& list, const Campaign& campaign);

}  // namespace talus
