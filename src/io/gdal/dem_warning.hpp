#pragma once
#include <string>
#include <vector>

#include "talus/terrain/dem_figures.hpp"

namespace talus::io {

/// Warnings where a raster looks as if it held no heights in metres, each with the figure that says so; the limits and
/// what they rest on are in docs/scenario.md, "A raster that is no DEM".
///
/// @param cell  size of its cells [m]
std::vector<std::string> dem_warnings(const std::string& path, const DemFigures& figures, double cell);

}  // namespace talus::io
