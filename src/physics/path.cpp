#include "talus/physics/path.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

double mixed(double from, double to, double share) {
  return from + share * (to - from);
}

/// A place on a piece of sliding. The acceleration is constant, so that the squares of the speed and of its part along
/// the way are linear in the way.
Motion slide_between(const Motion& from, const Motion& to, double share) {
  Motion m = from;
  const double duration = to.time - from.time;
  const Vec3 way = to.position - from.position;
  const double length = way.norm();
  m.position += share * way;
  if (!(duration > 0.0) || !(length > 0.0)) return m;
  const Vec3 first = from.velocity, last = 2.0 / duration * way - first;  // the mean of both is way / duration
  const double ahead = first.dot(way) / length, ahead_last = last.dot(way) / length;
  const double ahead_there = std::sqrt(mixed(ahead * ahead, ahead_last * ahead_last, share));
  const double mean = 0.5 * (ahead + ahead_there);
  const double time = mean > 0.0 ? std::min(duration, share * length / mean) : 0.0;
  m.time += time;
  m.velocity += time / duration * (last - first);
  const double speed = std::sqrt(mixed(first.squaredNorm(), last.squaredNorm(), share)), turned = m.velocity.norm();
  if (turned > 0.0) m.velocity *= speed / turned;
  return m;
}

}  // namespace

Motion motion_between(const Vertex& from, const Vertex& to, double share) {
  if (from.event == Event::Slide) return slide_between(from.motion, to.motion, share);
  const double t = share * (to.motion.time - from.motion.time);
  Motion m = from.motion;
  m.time += t;
  m.position += t * from.motion.velocity;
  m.position.z() -= 0.5 * kGravity * t * t;
  m.velocity.z() -= kGravity * t;
  return m;
}

}  // namespace talus
