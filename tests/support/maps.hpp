#pragma once
#include <span>

#include "talus/products/maps.hpp"

namespace talus::test {

/// Fills a whole row of a map: values[band * columns + column].
inline void fill_row(const Map& map, int row, std::span<double> values) {
  map.fill({0, row, static_cast<int>(values.size() / map.bands.size()), 1}, values);
}

}  // namespace talus::test
