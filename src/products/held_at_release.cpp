#include "talus/products/held_at_release.hpp"

#include <cmath>

namespace talus {

bool held_at_release(const StopRow& row) {
  if (!rests_on_ground(row.end)) return false;
  return std::hypot(row.x - row.x_release, row.y - row.y_release) <= 2.0 * row.diameter;
}

}  // namespace talus
