#pragma once
#include <vector>

#include "talus/io/results/write_rasters.hpp"

namespace talus::run {

/// Largest number of maps written at once: each needs room on the disk for its draft.
inline constexpr int kMapsAtOnce = 4;

/// Writes maps and their styles, several at a time. Throws Interrupted if `target.proceed` returns false.
void write_maps(const std::vector<Map>& maps, const io::MapTarget& target, int threads);

}  // namespace talus::run
