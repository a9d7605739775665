#pragma once
#include <cstdint>

#include "talus/terrain/raster.hpp"

namespace talus {

/// Figures of a raster of heights by which one sees whether it is a terrain. Of rasters of more than a million cells,
/// from rows that are evenly spread.
struct DemFigures {
  std::uint64_t cells = 0;    ///< with a slope
  double median_slope = 0.0;  ///< [rad]
  double steep_share = 0.0;   ///< of the cells, steeper than 80 degrees
  double flat_share = 0.0;    ///< of the cells, without any slope
  double step = 0.0;  ///< [m] all heights are multiples of it: 10, 5, 2, 1, 0.5, 0.3048 (a foot) ... 0.01; 0: of none
  double bend_share = 0.0;  ///< of three cells in a row, those not in a straight line: 0 of planes, 1 of rough ground
};

DemFigures dem_figures(const Raster<float>& heights);

}  // namespace talus
