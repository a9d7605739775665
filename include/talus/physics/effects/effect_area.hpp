#pragma once
#include <cstdint>
#include <vector>

#include "talus/terrain/raster.hpp"

namespace talus {

/// Area where an effect acts: everywhere, in some zones, or in the cells of a mask (polygons).
struct EffectArea {
  std::vector<std::uint8_t> zones;  ///< per zone of the cover: 1 if it acts there; empty: in all zones
  Raster<std::uint8_t> mask;        ///< per cell: 1 if it acts there; empty: everywhere

  bool covers(std::uint8_t zone, double x, double y) const {
    return (zones.empty() || zones[zone] != 0) &&
           (mask.values.empty() || mask.at(mask.grid.column_of(x), mask.grid.row_of(y)) != 0);
  }
};

}  // namespace talus
