#include "talus/terrain/surface.hpp"

namespace talus {
namespace {

constexpr double kAlongCrease = 1e-9;  // share of the speed across the crease below which a block moves along it

/// The plane that holds the crease, with the mean of the slopes of both halves.
Patch between_halves(const Patch& patch, Crease crease) {
  const Patch south = half_of(patch, crease, false), north = half_of(patch, crease, true);
  return {0.5 * (south.corner + north.corner), 0.5 * (south.east + north.east), 0.5 * (south.north + north.north), 0.0};
}

}  // namespace

std::optional<SurfaceKind> surface_kind(std::string_view name) {
  for (const SurfaceKind kind : {SurfaceKind::Bilinear, SurfaceKind::Creased})
    if (name == name_of(kind)) return kind;
  return std::nullopt;
}

Patch Surface::facet_of(const Patch& patch, Crease along, const Eigen::Vector2d& place, const Vec3& velocity) const {
  const double p = place.x(), q = place.y();
  const double rate_p = velocity.x() * per_cell_x(), rate_q = velocity.y() * per_cell_y();
  const bool on_it = std::abs(across(along, p, q)) <= kOnCrease;
  if (on_it && std::abs(rate_across(along, rate_p, rate_q)) <= kAlongCrease * (std::abs(rate_p) + std::abs(rate_q)))
    return between_halves(patch, along);
  return half_of(patch, along, on_northern_half(along, p, q, rate_p, rate_q));
}

std::optional<double> Surface::height(double x, double y) const {
  const PatchIndex i = patch_at(x, y);
  Patch patch;
  if (!read(i, patch)) return std::nullopt;
  const double p = u_of(x) - i.column, q = v_of(y) - i.row;
  return facet(patch, p, q, Vec3::Zero()).height(p, q);
}

}  // namespace talus
