#include "talus/physics/path.hpp"

namespace talus {

Motion motion_between(const Vertex& from, const Vertex& to, double share) {
  const double t = share * (to.motion.time - from.motion.time);
  Motion m = from.motion;
  m.time += t;
  if (from.event == Event::Slide) {
    const double duration = to.motion.time - from.motion.time;
    const Vec3 way = to.motion.position - from.motion.position;
    m.position += share * way;
    if (duration > 0.0) m.velocity += 2.0 * share * (way / duration - from.motion.velocity);  // constant acceleration
    return m;
  }
  m.position += t * from.motion.velocity;
  m.position.z() -= 0.5 * kGravity * t * t;
  m.velocity.z() -= kGravity * t;
  return m;
}

}  // namespace talus
