#include "barrier_watch.hpp"

#include <algorithm>
#include <cmath>

#include "talus/physics/barriers.hpp"
#include "talus/physics/span_speed.hpp"

namespace talus {
namespace {

constexpr double kGap = 1e-3;  // between a block that is caught and the line, along its way [m]

double plan_length(const Vertex& from, const Vertex& to) {
  return (to.motion.position - from.motion.position).head<2>().norm();
}

/// Length in space of the first share of the way between two vertices [m].
double length_of(const Vertex& from, const Vertex& to, double share) {
  if (from.event == Event::Slide) return share * (to.motion.position - from.motion.position).norm();
  return arc_length(from.motion.velocity, share * (to.motion.time - from.motion.time));
}

float mixed(float from, float to, float share) {
  return from + share * (to - from);
}

/// Shortens a span to its first share.
void shorten(Span& span, float share) {
  span.rise_to = rise_at(span, share);
  span.p_to = mixed(span.p_from, span.p_to, share);
  span.q_to = mixed(span.q_from, span.q_to, share);
  const float rise = span.height_to - span.height_from - span.bend * (1.0F - share);
  span.height_to = std::max(0.0F, span.height_from + share * rise);
  span.bend *= share * share;
}

}  // namespace

void BarrierWatch::begin(const Path& path, std::size_t first) {
  first_vertex_ = first;
  first_span_ = path.spans.size();
  length_ = path.length;
  plan_length_ = path.plan_length;
}

Meeting BarrierWatch::look(Motion& motion, PatchIndex& at, const Block& body, Path& path) {
  const std::size_t end = path.vertices.size();
  const Vertex last{motion, Event::End};
  for (std::size_t i = first_vertex_; i < end; ++i) {
    const Meeting met = look(i, i + 1 < end ? path.vertices[i + 1] : last, motion, body, path);
    if (met == Meeting::Over) continue;
    at = world_.surface.patch_at(motion.position.x(), motion.position.y());
    return met;
  }
  return Meeting::Over;
}

Meeting BarrierWatch::look(std::size_t vertex, const Vertex& to, Motion& motion, const Block& body, Path& path) {
  const Vertex& from = path.vertices[vertex];
  const Eigen::Vector2d a = from.motion.position.head<2>(), b = to.motion.position.head<2>();
  std::optional<Barriers::Cut> cut;
  while ((cut = world_.barriers->next(a, b, cut))) {
    if (cut->segment == broken_ && a == broken_at_) continue;
    Motion there = motion_between(from, to, cut->share);
    const double ground = world_.surface.height(there.position.x(), there.position.y()).value_or(there.position.z());
    const double energy = 0.5 * body.mass * there.velocity.squaredNorm();
    const Barrier& barrier = world_.barriers->list()[cut->barrier];
    const Meeting how = meeting(barrier, std::max(0.0, there.position.z() - ground), energy);
    path.barriers.push_back({cut->barrier, how, cut->along});
    if (how == Meeting::Over) continue;
    const double share = how == Meeting::Broken ? cut->share : std::max(0.0, cut->share - kGap / (b - a).norm());
    if (how == Meeting::Caught) {
      there = motion_between(from, to, share);
      there.velocity.setZero();
      there.spin.setZero();
    } else {
      there.velocity *= kept_speed(energy, barrier.capacity);
      if (from.event == Event::Slide) there.position.z() = ground;
      broken_ = cut->segment;
      broken_at_ = there.position.head<2>();
    }
    cut_off(vertex, to, share, path);
    motion = there;
    if (how == Meeting::Broken) path.vertices.push_back({motion, Event::Barrier});
    return how;
  }
  return Meeting::Over;
}

/// Spans hold no reference to their vertices. So the span with the cut is found by the length in plan from the start of
/// the leg.
void BarrierWatch::cut_off(std::size_t vertex, const Vertex& to, double share, Path& path) const {
  double way = 0.0, length = 0.0;
  for (std::size_t i = first_vertex_; i < vertex; ++i) {
    way += plan_length(path.vertices[i], path.vertices[i + 1]);
    length += length_of(path.vertices[i], path.vertices[i + 1], 1.0);
  }
  way += share * plan_length(path.vertices[vertex], to);
  path.length = length_ + length + length_of(path.vertices[vertex], to, share);
  path.plan_length = plan_length_ + way;
  path.vertices.resize(vertex + 1, path.vertices[vertex]);

  const Grid& grid = world_.surface.grid();
  for (std::size_t i = first_span_; i < path.spans.size(); ++i) {
    Span& span = path.spans[i];
    const double across = std::hypot((span.p_to - span.p_from) * grid.cell_x, (span.q_to - span.q_from) * grid.cell_y);
    if (way <= across) {
      shorten(span, across > 0.0 ? static_cast<float>(std::max(0.0, way) / across) : 1.0F);
      path.spans.resize(i + 1);
      return;
    }
    way -= across;
  }
}

}  // namespace talus
