#pragma once
#include <filesystem>

#include "talus/io/origin/origin.hpp"
#include "talus/terrain/raster.hpp"

namespace talus::io {

/// Writes the true pits of a terrain (`pit_depth`) as the layer `pits` of a GeoPackage: the centre of each cell, row by
/// row from the north-west, with depth_m and z. Without any the layer is empty.
///
/// Throws std::runtime_error, one line with the file and the cause.
void write_pits(const std::filesystem::path& file, const Raster<float>& heights, const GeoReference& geo);

}  // namespace talus::io
