#pragma once
#include <filesystem>
#include <vector>

#include "talus/io/results/write_rasters.hpp"

/// Each needs room on the disk for its draft.
inline constexpr int kMapsAtOnce = 4;

/// Writes maps and their styles, several at a time. Throws Interrupted where the user has ended the program.
void write_maps(const std::vector<talus::Map>& maps, const talus::io::MapTarget& target, int threads);
