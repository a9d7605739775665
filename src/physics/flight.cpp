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
};

/// @tparam kBounded  the flight ends after `longest`; if false, the compiler removes this check
template <bool kBounded>  // NOLINTNEXTLINE(readability-function-size): 70 lines, one loop without calls
Outcome walk(const Surface& surface, Motion& motion, PatchIndex& at, bool grounded, Path& path,
             [[maybe_unused]] double longest) {
  const Grid& grid = surface.grid();
  const Vec3 start = motion.position, v = motion.velocity;
  const double rate_u = v.x() * surface.per_cell_x(), rate_v = v.y() * surface.per_cell_y();
  const double u0 = surface.u_of(start.x()), v0 = surface.v_of(start.y());
  const auto plan2 = static_cast<float>(v.x() * v.x() + v.y() * v.y());
  Lines columns(u0 - at.column, rate_u), rows(v0 - at.row, rate_v);
  double t = 0.0;
  double p = u0 - at.column, q = v0 - at.row, z = start.z();
  Outcome outcome = Outcome::Left;
  for (int crossed = 0; crossed <= grid.columns + grid.rows + 2; ++crossed) {
    Patch patch;
    if (!surface.read(at, patch)) break;
    const double edge = std::min(columns.next, rows.next) - t;
    const double until = kBounded ? std::min(edge, longest - t) : edge;
    const double rise = v.z() - kGravity * t;
    const bool leaving = grounded && crossed == 0;  // on the surface and moving away from it, in spite of rounding
    TALUS_EXPECT(crossed == 0 || !(z < patch.height(p, q) - 1e-3), "a block that flies on is not below the ground");
    const double f0 = leaving ? 0.0 : std::max(z - patch.height(p, q), 0.0);
    const double slope = patch.east * rate_u + patch.north * rate_v + patch.twist * (p * rate_v + q * rate_u);
    const double f1 = leaving ? std::max(rise - slope, 0.0) : rise - slope;  // NaN stays NaN
    const double f2 = -0.5 * kGravity - patch.twist * rate_u * rate_v;
    const double contact = first_contact(f0, f1, f2, until);
    const bool landed = contact < kNever;
    const double dt = landed ? contact : until;
    if (!(dt < kNever)) break;  // NaN or no end: cannot happen above a finite patch, and must not loop
    TALUS_EXPECT(dt > -1e-9, "a flight goes forward in time");
    t += dt;
    const double p_from = p, q_from = q;
    p = u0 + rate_u * t - at.column;
    q = v0 + rate_v * t - at.row;
    Span& span = path.spans.emplace_back();
    span.patch = at;
    span.p_from = static_cast<float>(p_from);
    span.q_from = static_cast<float>(q_from);
    span.p_to = static_cast<float>(p);
    span.q_to = static_cast<float>(q);
    span.height_from = static_cast<float>(f0);
    span.height_to = landed ? 0.0F : static_cast<float>(std::max(0.0, f0 + dt * (f1 + dt * f2)));
    span.bend = static_cast<float>(f2 * dt * dt);
    span.plan_speed_squared = plan2;
    span.rise_from = static_cast<float>(rise);
    span.rise_to = static_cast<float>(v.z() - kGravity * t);
    if (landed) {
      z = patch.height(p, q);
      outcome = Outcome::Landed;
      break;
    }
    if (kBounded && until < edge) {
      outcome = Outcome::Aloft;
      break;
    }
    z = start.z() + t * (v.z() - 0.5 * kGravity * t);
    if (columns.next <= rows.next) {
      at.column += columns.step;
      p -= columns.step;
      columns.next += columns.every;
    } else {
      at.row += rows.step;
      q -= rows.step;
      rows.next += rows.every;
    }
  }
  path.length += arc_length(v, t);
  path.plan_length += std::sqrt(v.x() * v.x() + v.y() * v.y()) * t;
  motion.time += t;
  motion.position = {start.x() + v.x() * t, start.y() + v.y() * t,
                     outcome == Outcome::Landed ? z : start.z() + t * (v.z() - 0.5 * kGravity * t)};
  motion.velocity.z() = v.z() - kGravity * t;
  return outcome;
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
