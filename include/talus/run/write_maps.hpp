#pragma once
#include <vector>

#include "talus/io/results/write_rasters.hpp"

namespace talus::run {

/// Maps that are written at once, at most: each needs room on the disk for its draft.
inline constexpr int kMapsAtOnce = 4;

/// Writes maps and their styles, several at a time. Throws Interrupted where `target.proceed` says no.
void write_maps(const std::vector<Map>& maps, const io::MapTarget& target, int threads);

}  // namespace talus::run
