#include "talus/terrain/surface.hpp"

namespace talus {

std::optional<SurfaceKind> surface_kind(std::string_view name) {
  for (const SurfaceKind kind : {SurfaceKind::Bilinear, SurfaceKind::Creased})
    if (name == name_of(kind)) return kind;
  return std::nullopt;
}

Patch Surface::facet_of(const Patch& patch, Crease along, const Eigen::Vector2d& place, const Vec3& velocity) const {
  return talus::facet_of<double>(patch, along == Crease::Rising, place.x(), place.y(), velocity.x() * per_cell_x(),
                                 velocity.y() * per_cell_y());
}

std::optional<double> Surface::height(double x, double y) const {
  const PatchIndex i = patch_at(x, y);
  Patch patch;
  if (!read(i, patch)) return std::nullopt;
  const double p = u_of(x) - i.column, q = v_of(y) - i.row;
  return facet(patch, p, q, Vec3::Zero()).height(p, q);
}

}  // namespace talus
