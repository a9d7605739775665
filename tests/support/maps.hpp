#pragma once
#include <span>
#include <vector>

#include "talus/products/maps.hpp"

namespace talus::test {

/// Fills a whole row of a map, band after band: values[band * columns + column].
inline void fill_row(const Map& map, int row, std::span<double> values) {
  const std::size_t bands = map.bands.size(), columns = values.size() / bands;
  std::vector<double> cells(values.size());
  map.fill({0, row, static_cast<int>(columns), 1}, cells);
  for (std::size_t i = 0; i < cells.size(); ++i) values[i % bands * columns + i / bands] = cells[i];
}

}  // namespace talus::test
