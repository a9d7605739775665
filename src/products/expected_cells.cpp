#include "talus/products/expected_cells.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

double expected_cells(std::span<const std::uint64_t> cells, double times, double most) {
  const auto one = static_cast<double>(cells[1]), two = static_cast<double>(cells[2]);
  const auto three = static_cast<double>(cells[3]);
  double reached = 0.0;
  for (const std::uint64_t count : cells) reached += static_cast<double>(count);
  if (times <= 1.0 || one == 0.0) return reached;
  if (two < 10.0 || three < 10.0) return std::min(most, reached + one * (times - 1.0));  // hardly any cell twice
  const double first = 2.0 * two / one, second = 3.0 * three / two;                      // (k + 1) q and (k + 2) q
  const double q = std::clamp(second - first, 0.02, 0.98), k = std::max(0.05, first / q - 1.0);
  const double unseen = one / (k * q), odds = q / (1.0 - q);
  return std::min(most, reached + unseen * (1.0 - std::pow((1.0 + odds * times) / (1.0 + odds), -k)));
}

}  // namespace talus
