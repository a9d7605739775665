#pragma once
#include <cstdint>
#include <vector>

#include "talus/terrain/raster.hpp"

namespace talus {

/// Where an effect acts: everywhere, in some zones, or in the cells of a mask (polygons).
struct EffectArea {
  std::vector<std::uint8_t> zones;  ///< by zone of the cover: 1 where it acts; empty: in all of them
  Raster<std::uint8_t> mask;        ///< 1 where it acts; empty: everywhere

  bool covers(std::uint8_t zone, double x, double y) const {
    return (zones.empty() || zones[zone] != 0) &&
           (mask.values.empty() || mask.at(mask.grid.column_of(x), mask.grid.row_of(y)) != 0);
  }
};

}  // namespace talus
