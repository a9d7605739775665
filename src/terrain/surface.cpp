#include "talus/terrain/surface.hpp"

namespace talus {

std::optional<double> Surface::height(double x, double y) const {
  const PatchIndex i = patch_at(x, y);
  Patch patch;
  if (!read(i, patch)) return std::nullopt;
  return patch.height(u_of(x) - i.column, v_of(y) - i.row);
}

}  // namespace talus
