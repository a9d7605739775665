#pragma once
#include "io/files/json.hpp"
#include "talus/io/results/weighting_file.hpp"

namespace talus::io {

/// What hazard.json and barrier_*.json record of frequencies that replaced those of the run: the file, its checksum,
/// what it says (`given`), the events per year of all blocks that follow, and `class_shares` where classes of blocks
/// keep their shares of the events.
Json json_of(const GivenFrequencies& frequencies, double events_per_year);

}  // namespace talus::io
