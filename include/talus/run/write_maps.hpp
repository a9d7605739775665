#pragma once
#include <vector>

#include "talus/io/results/write_rasters.hpp"

namespace talus::run {

/// Writes maps and their styles. Throws Interrupted if `target.proceed` returns false.
void write_maps(const std::vector<Map>& maps, const io::MapTarget& target, int threads);

}  // namespace talus::run
