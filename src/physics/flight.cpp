#include "talus/physics/flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "crossing.hpp"
#include "talus/base/expect.hpp"

namespace talus {
namespace {

/// Grid lines of one direction, with the step to the patch beyond.
struct Steps : Lines<double> {
  int step;  // -1 or +1

  Steps(double share, double rate) : Lines(share, rate), step(rate < 0.0 ? -1 : 1) {}

  /// Moves a patch index and a position in the patch across the next line.
  void cross(int& index, double& share) {
    index += step;
    share -= step;
    next += every;
  }
};

/// Replaces a creased patch by the half over which the block is. Returns the time until the block is over the other
/// half [s]; infinite if it never is.
double enter_half(Patch& patch, bool rising, const Course<double>& course) {
  const bool north = on_northern_half<double>(rising, course.p, course.q, course.rate_u, course.rate_v);
  patch = half_of<double>(patch, rising, north);
  return time_to_crease<double>(rising, north, course);
}

/// The three parts of a span.
void set_place(Span& span, PatchIndex at, const std::array<double, 4>& p_q) {
  span.patch = at;
  span.p_from = static_cast<float>(p_q[0]);
  span.q_from = static_cast<float>(p_q[1]);
  span.p_to = static_cast<float>(p_q[2]);
  span.q_to = static_cast<float>(p_q[3]);
}
void set_height(Span& span, double from, double to, double bend) {
  span.height_from = static_cast<float>(from);
  span.height_to = static_cast<float>(to);
  span.bend = static_cast<float>(bend);
}
void set_speed(Span& span, float plan_squared, double rise_from, double rise_to) {
  span.plan_speed_squared = plan_squared;
  span.rise_from = static_cast<float>(rise_from);
  span.rise_to = static_cast<float>(rise_to);
}

/// @tparam kBounded  the flight ends after `longest`; if false, the compiler removes this check
/// @tparam kCreased  patches may have creases
///
/// Where it keeps its numbers decides the speed of the program: start and velocity as copies, and no struct of them.
template <bool kBounded, bool kCreased>
FlightEnd walk(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path,
               [[maybe_unused]] double longest) {
  const Vec3 start = motion.position, v = motion.velocity;
  const double rate_u = v.x() * surface.per_cell_x(), rate_v = v.y() * surface.per_cell_y();
  const double u0 = surface.u_of(start.x()), v0 = surface.v_of(start.y());
  const auto plan2 = static_cast<float>(v.x() * v.x() + v.y() * v.y());
  Steps columns(u0 - at.column, rate_u), rows(v0 - at.row, rate_v);
  double t = 0.0, p = u0 - at.column, q = v0 - at.row, z = start.z();
  FlightEnd end = FlightEnd::Left;
  const int most = (kCreased ? 2 : 1) * (surface.grid().columns + surface.grid().rows + 2);
  for (int crossed = 0; crossed <= most; ++crossed) {
    Patch patch;
    if (!surface.read(at, patch)) break;
    double crease_after = kNever;
    if constexpr (kCreased)
      if (const Creases<double> creases = creases_of(patch); creases.there()) [[unlikely]]
        crease_after = enter_half(patch, creases.rising, {p, q, z, rate_u, rate_v, 0.0});
    const double edge = std::min(columns.next, rows.next) - t;
    const double ahead = kCreased ? std::min(edge, crease_after) : edge;
    const double until = kBounded ? std::min(ahead, longest - t) : ahead;
    const double rise = v.z() - kGravity * t;
    const bool leaving = grounded && crossed == 0;  // on the surface and moving away from it, in spite of rounding
    TALUS_EXPECT(crossed == 0 || !(z < patch.height(p, q) - 1e-3), "a block that flies on is not below the ground");
    const auto [f0, f1, f2] = clearance_over<double>(patch, {p, q, z, rate_u, rate_v, rise}, leaving);
    const double contact = first_contact(f0, f1, f2, until);
    const bool landed = contact < kNever;
    const double dt = landed ? contact : until;
    if (!(dt < kNever)) break;  // NaN or no end: cannot happen above a finite patch, and must not loop
    TALUS_EXPECT(dt > -1e-9, "a flight goes forward in time");
    t += dt;
    const double p_from = p, q_from = q;
    p = u0 + rate_u * t - at.column;
    q = v0 + rate_v * t - at.row;
    Span& span = path.spans.emplace_back(Span{});
    set_place(span, at, {p_from, q_from, p, q});
    set_height(span, f0, landed ? 0.0 : std::max(0.0, f0 + dt * (f1 + dt * f2)), f2 * dt * dt);
    set_speed(span, plan2, rise, v.z() - kGravity * t);
    if (landed) {
      z = patch.height(p, q);
      end = FlightEnd::Landed;
      break;
    }
    if (kBounded && until < ahead) {
      end = FlightEnd::Aloft;
      break;
    }
    z = start.z() + t * (v.z() - 0.5 * kGravity * t);
    if (kCreased && crease_after < edge) continue;  // over the other half of the same patch
    columns.next <= rows.next ? columns.cross(at.column, p) : rows.cross(at.row, q);
  }
  path.length += arc_length<double>(v, t);
  path.plan_length += std::sqrt(v.x() * v.x() + v.y() * v.y()) * t;
  motion.time += t;
  motion.position = {start.x() + v.x() * t, start.y() + v.y() * t,
                     end == FlightEnd::Landed ? z : start.z() + t * (v.z() - 0.5 * kGravity * t)};
  motion.velocity.z() = v.z() - kGravity * t;
  return end;
}

/// The walk for this kind of surface.
template <bool kBounded>
FlightEnd walk(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path, double longest) {
  return surface.creased() ? walk<kBounded, true>(surface, motion, at, grounded, path, longest)
                           : walk<kBounded, false>(surface, motion, at, grounded, path, longest);
}

}  // namespace

double arc_length(const Vec3& v, double duration) {
  return arc_length<double>(v, duration);
}

[[gnu::flatten]] FlightEnd fly(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path) {
  return walk<false>(surface, motion, at, grounded, path, kNever);
}

FlightEnd fly(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path, double longest) {
  return walk<true>(surface, motion, at, grounded, path, longest);
}

}  // namespace talus
