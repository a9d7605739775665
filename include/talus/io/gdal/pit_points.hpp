#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "talus/io/origin/origin.hpp"
#include "talus/terrain/raster.hpp"

namespace talus::io {

/// The layer of the file of pits.
inline const std::vector<std::string> kPitLayers{"pits"};

/// Writes the true pits of a terrain (`pit_depth`) and its dammed cells (`dam_height`) as the layer `pits` of a
/// GeoPackage: the centre of each cell, row by row from the north-west, with kind (pit or dammed), depth_m below the
/// lowest of its eight (pit) or four (dammed) neighbours, and z. Without any the layer is empty.
///
/// @param style  of the layer in QGIS
/// Throws std::runtime_error, one line with the file and the cause.
void write_pits(const std::filesystem::path& file, const Raster<float>& heights, const GeoReference& geo,
                const std::string& style);

}  // namespace talus::io
