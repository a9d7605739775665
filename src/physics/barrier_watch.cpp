#include "barrier_watch.hpp"

#include <algorithm>
#include <cmath>

#include "talus/physics/span_speed.hpp"

namespace talus {
namespace {

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
  span.height_to = std::max(0.0F, height_at(span, share));
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
  const auto met = first(a, b, body, path, [&](double share) { return motion_between(from, to, share); });
  if (!met) return Meeting::Over;
  motion = motion_between(from, to, met->share);
  if (met->how == Meeting::Broken && from.event == Event::Slide) motion.position.z() = ground_at(motion.position);
  cut_off(vertex, to, met->share, path);
  act(*met, body, motion, path);
  return met->how;
}

double BarrierWatch::ground_at(const Vec3& place) const {
  return world_.surface.height(place.x(), place.y()).value_or(place.z());
}

Meeting BarrierWatch::meet(const Barriers::Cut& cut, const Motion& there, const Block& body, double taken,
                           Path& path) const {
  const double clearance = std::max(0.0, there.position.z() - ground_at(there.position));
  const double energy = 0.5 * body.mass * there.velocity.squaredNorm() - taken;
  const Meeting how = meeting(world_.barriers->list()[cut.barrier], clearance, energy);
  path.barriers.push_back({cut.barrier, how, cut.along});
  return how;
}

bool BarrierWatch::was_met_here(std::uint32_t barrier, const Path& path) const {
  return std::any_of(path.barriers.begin() + static_cast<std::ptrdiff_t>(met_here_), path.barriers.end(),
                     [barrier](const BarrierPassage& met) { return met.barrier == barrier; });
}

void BarrierWatch::act(const BarrierMet& met, const Block& body, Motion& motion, Path& path) {
  if (met.how == Meeting::Caught) {
    motion.velocity.setZero();
    motion.spin.setZero();
    return;
  }
  const double energy = 0.5 * body.mass * motion.velocity.squaredNorm();
  motion.velocity *= kept_speed(energy, met.taken);
  const Eigen::Vector2d place = motion.position.head<2>();
  if (!((place - broken_at_).norm() <= kOneLine)) met_here_ = met.first_of_leg;
  broken_at_ = place;
  path.vertices.push_back({motion, Event::Barrier});
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
