#include "staying.hpp"

namespace talus {

End end_of_staying(const World& world, const Ground& ground, const Motion& motion, PatchIndex at, double diameter) {
  Patch patch;
  if (!world.surface.read(at, patch)) return End::Stopped;
  const double p = world.surface.u_of(motion.position.x()) - at.column;
  const double q = world.surface.v_of(motion.position.y()) - at.row;
  const Eigen::Vector2d gradient = world.surface.gradient(world.surface.facet(patch, p, q, motion.velocity), p, q);
  if (gradient.norm() <= ground.tan_phi) return End::Stopped;
  const double reach = 2.0 * diameter;
  const Eigen::Vector2d below = motion.position.head<2>() - reach * gradient.normalized();
  const std::optional<double> height = world.surface.height(below.x(), below.y());
  const bool open = !height || motion.position.z() - *height > reach * ground.tan_phi;
  return open ? End::Stopped : End::Trapped;
}

}  // namespace talus
