#pragma once
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The release of block `block` of source cell `source`: a pure function, no list of releases is stored.
/// A block released where there is no terrain has a height of NaN and ends `left` at once.
Release make_release(const Scenario& scenario, std::uint32_t source, std::uint32_t block);

/// Whether the path of this block is one of the `scenario.output.paths` that are written as vectors: evenly spread
/// over all releases, whatever the number of threads.
bool is_recorded(const Scenario& scenario, std::uint32_t source, std::uint32_t block);

}  // namespace talus
