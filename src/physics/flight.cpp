#include "talus/physics/flight.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Times at which a straight line in plan crosses the successive grid lines of one direction.
struct Lines {
  double next, every;  // [s], infinite if the line is parallel to these grid lines
  int step;            // -1 or +1

  /// @param share  position in the patch, 0..1
  /// @param rate   speed [patches/s]
  Lines(double share, double rate) : next(kNever), every(kNever), step(rate < 0.0 ? -1 : 1) {
    if (rate == 0.0) return;
    every = 1.0 / std::abs(rate);
    next = std::max(0.0, rate > 0.0 ? 1.0 - share : share) * every;
  }

  /// Moves a patch index and a position in the patch across the next line.
  void cross(int& index, double& share) {
    index += step;
    share -= step;
    next += every;
  }
};

/// A flight in patch coordinates: straight in plan, a parabola in height.
struct Course {
  Vec3 start, velocity;
  double rate_u, rate_v, u0, v0;
  float plan_speed_squared;

  Course(const Surface& surface, const Motion& motion)
      : start(motion.position),
        velocity(motion.velocity),
        rate_u(velocity.x() * surface.per_cell_x()),
        rate_v(velocity.y() * surface.per_cell_y()),
        u0(surface.u_of(start.x())),
        v0(surface.v_of(start.y())),
        plan_speed_squared(static_cast<float>(velocity.x() * velocity.x() + velocity.y() * velocity.y())) {}

  double rise(double t) const { return velocity.z() - kGravity * t; }
  double z(double t) const { return start.z() + t * (velocity.z() - 0.5 * kGravity * t); }
};

/// A moment of a flight: the time, the place in the current patch, the height.
struct Moment {
  double t, p, q, z;
};

/// Clearance of a flight over a patch from a moment on: f0 + f1 t + f2 t^2.
struct Clearance {
  double f0, f1, f2;
};

/// @param leaving  on the surface and moving away from it, in spite of rounding
Clearance clearance_of(const Course& course, const Patch& patch, const Moment& now, bool leaving) {
  const double f0 = leaving ? 0.0 : std::max(now.z - patch.height(now.p, now.q), 0.0);
  const double slope = patch.east * course.rate_u + patch.north * course.rate_v +
                       patch.twist * (now.p * course.rate_v + now.q * course.rate_u);
  const double rise = course.rise(now.t) - slope;
  return {f0, leaving ? std::max(rise, 0.0) : rise,  // NaN stays NaN
          -0.5 * kGravity - patch.twist * course.rate_u * course.rate_v};
}

/// Replaces a creased patch by the half over which the block is. Returns the time until the block is over the other
/// half [s]; infinite if it never is.
double enter_half(Patch& patch, Crease crease, const Course& course, const Moment& now) {
  const bool north = on_northern_half(crease, now.p, now.q, course.rate_u, course.rate_v);
  const double rate = rate_across(crease, course.rate_u, course.rate_v);
  patch = half_of(patch, crease, north);
  return (north ? rate < 0.0 : rate > 0.0) ? -across(crease, now.p, now.q) / rate : kNever;
}

/// A piece of a flight over one plane or bilinear patch.
struct Piece {
  Moment from, to;
  Clearance clearance;
  double duration;
  bool landed;
};

void record_span(Path& path, const Course& course, PatchIndex at, const Piece& piece) {
  const auto& [f0, f1, f2] = piece.clearance;
  const double dt = piece.duration;
  Span& span = path.spans.emplace_back();
  span.patch = at;
  span.p_from = static_cast<float>(piece.from.p);
  span.q_from = static_cast<float>(piece.from.q);
  span.p_to = static_cast<float>(piece.to.p);
  span.q_to = static_cast<float>(piece.to.q);
  span.height_from = static_cast<float>(f0);
  span.height_to = piece.landed ? 0.0F : static_cast<float>(std::max(0.0, f0 + dt * (f1 + dt * f2)));
  span.bend = static_cast<float>(f2 * dt * dt);
  span.plan_speed_squared = course.plan_speed_squared;
  span.rise_from = static_cast<float>(course.rise(piece.from.t));
  span.rise_to = static_cast<float>(course.rise(piece.to.t));
}

/// Adds the length of a flight to the path and moves the block to its end.
void finish(const Course& course, double duration, double z, Motion& motion, Path& path) {
  const Vec3 &start = course.start, &v = course.velocity;
  path.length += arc_length(v, duration);
  path.plan_length += std::sqrt(v.x() * v.x() + v.y() * v.y()) * duration;
  motion.time += duration;
  motion.position = {start.x() + v.x() * duration, start.y() + v.y() * duration, z};
  motion.velocity.z() = course.rise(duration);
}

/// @tparam kBounded  the flight ends after `longest`; if false, the compiler removes this check
/// @tparam kCreased  patches may have creases
template <bool kBounded, bool kCreased>
Outcome walk(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path,
             [[maybe_unused]] double longest) {
  const Course course(surface, motion);
  Moment now{0.0, course.u0 - at.column, course.v0 - at.row, course.start.z()};
  Lines columns(now.p, course.rate_u), rows(now.q, course.rate_v);
  const int most = (kCreased ? 2 : 1) * (surface.grid().columns + surface.grid().rows + 2);
  Outcome outcome = Outcome::Left;
  for (int crossed = 0; crossed <= most; ++crossed) {
    Patch patch;
    if (!surface.read(at, patch)) break;
    double crease_after = kNever;
    if constexpr (kCreased)
      if (const Crease crease = crease_of(patch); crease != Crease::None) [[unlikely]]
        crease_after = enter_half(patch, crease, course, now);
    TALUS_EXPECT(crossed == 0 || !(now.z < patch.height(now.p, now.q) - 1e-3),
                 "a block that flies on is not below the ground");
    const double edge_after = std::min(columns.next, rows.next) - now.t;
    const double ahead = kCreased ? std::min(edge_after, crease_after) : edge_after;
    const double until = kBounded ? std::min(ahead, longest - now.t) : ahead;
    const Clearance clearance = clearance_of(course, patch, now, grounded && crossed == 0);
    const double contact = first_contact(clearance.f0, clearance.f1, clearance.f2, until);
    const bool landed = contact < kNever;
    const double dt = landed ? contact : until;
    if (!(dt < kNever)) break;  // NaN or no end: cannot happen above a finite patch, and must not loop
    TALUS_EXPECT(dt > -1e-9, "a flight goes forward in time");
    const Moment from = now;
    now.t += dt;
    now.p = course.u0 + course.rate_u * now.t - at.column;
    now.q = course.v0 + course.rate_v * now.t - at.row;
    record_span(path, course, at, {from, now, clearance, dt, landed});
    now.z = landed ? patch.height(now.p, now.q) : course.z(now.t);
    if (landed) outcome = Outcome::Landed;
    if (kBounded && !landed && until < ahead) outcome = Outcome::Aloft;
    if (outcome != Outcome::Left) break;
    if (kCreased && crease_after < edge_after) continue;  // over the other half of the same patch
    columns.next <= rows.next ? columns.cross(at.column, now.p) : rows.cross(at.row, now.q);
  }
  finish(course, now.t, outcome == Outcome::Landed ? now.z : course.z(now.t), motion, path);
  return outcome;
}

/// The walk for this kind of surface.
template <bool kBounded>
Outcome walk(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path, double longest) {
  return surface.creased() ? walk<kBounded, true>(surface, motion, at, grounded, path, longest)
                           : walk<kBounded, false>(surface, motion, at, grounded, path, longest);
}

}  // namespace

double arc_length(const Vec3& v, double duration) {
  constexpr double kNode = 0.7745966692414834;  // sqrt(3/5)
  const double plan2 = v.x() * v.x() + v.y() * v.y();
  const auto speed = [&](double share) {
    const double rise = v.z() - kGravity * duration * share;
    return std::sqrt(plan2 + rise * rise);
  };
  return duration / 18.0 * (5.0 * speed(0.5 - 0.5 * kNode) + 8.0 * speed(0.5) + 5.0 * speed(0.5 + 0.5 * kNode));
}

[[gnu::flatten]] Outcome fly(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path) {
  return walk<false>(surface, motion, at, grounded, path, kNever);
}

Outcome fly(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path, double longest) {
  return walk<true>(surface, motion, at, grounded, path, longest);
}

}  // namespace talus
