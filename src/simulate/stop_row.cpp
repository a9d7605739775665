#include "talus/simulate/stop_row.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/bounds.hpp"

namespace talus {

double energy_line_angle(const Vec3& from, const Vec3& to) {
  const double drop = from.z() - to.z(), distance = std::hypot(to.x() - from.x(), to.y() - from.y());
  return drop == 0.0 && distance == 0.0 ? kNotGiven : std::atan2(drop, distance);
}

StopRow stop_row(const Release& release, const Path& path) {
  const Motion& end = path.vertices.back().motion;
  double fastest = 0.0;
  for (const Span& span : path.spans)
    fastest = std::max<double>(
        fastest, span.plan_speed_squared + std::max(span.rise_from * span.rise_from, span.rise_to * span.rise_to));
  StopRow row{};
  row.source = release.source;
  row.block = release.block;
  row.end = path.end;
  row.diameter = static_cast<float>(path.breaks.empty() ? release.body.diameter : path.breaks.back().body.diameter);
  row.mass = static_cast<float>(path.mass);
  row.x_release = static_cast<float>(release.motion.position.x());
  row.y_release = static_cast<float>(release.motion.position.y());
  row.energy_line = static_cast<float>(energy_line_angle(release.motion.position, end.position));
  row.x = end.position.x();
  row.y = end.position.y();
  row.z = end.position.z();
  row.seconds = static_cast<float>(end.time);
  row.max_speed = static_cast<float>(std::sqrt(fastest));
  row.end_speed = static_cast<float>(end.velocity.norm());
  row.length = static_cast<float>(path.length);
  row.plan_length = static_cast<float>(path.plan_length);
  row.impacts = path.impacts;
  return row;
}

std::vector<PathPoint> points_of(const Path& path, double spacing) {
  std::vector<PathPoint> points;
  const auto push = [&points](const Vec3& p, double time) { points.push_back({p.x(), p.y(), p.z(), time}); };
  for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
    const Motion &from = path.vertices[i].motion, &to = path.vertices[i + 1].motion;
    push(from.position, from.time);
    if (path.vertices[i].event == Event::Slide) continue;
    const double plan = (to.position - from.position).head<2>().norm();
    const int pieces = static_cast<int>(std::ceil(plan / spacing));
    for (int k = 1; k < pieces; ++k) {
      const double t = (to.time - from.time) * k / pieces;
      Vec3 p = from.position + t * from.velocity;
      p.z() -= 0.5 * kGravity * t * t;
      push(p, from.time + t);
    }
  }
  push(path.vertices.back().motion.position, path.vertices.back().motion.time);
  return points;
}

}  // namespace talus
