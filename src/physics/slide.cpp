#include "talus/physics/slide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "edge.hpp"
#include "sliding_friction.hpp"
#include "talus/base/expect.hpp"
#include "talus/physics/flight.hpp"

namespace talus {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr int kMaxPieces = 1000;
constexpr int kMaxHalvings = 20;
constexpr int kMaxShort = 12;         // successive crossings of edges with almost no way between: a pit
constexpr double kErrorShare = 1e-3;  // of the diameter, per piece
constexpr double kRounding = 1e-9;    // of the speed: below it the ground does not fall away at an edge

/// A piece that ends so much higher, or faster by as much, has not gained energy [m].
constexpr double kHeightRounding = 1e-10;

/// A piece of constant acceleration.
struct Piece {
  Vec2 acceleration;
  double duration;
};

/// A long piece from `place` with an error of the position below `tolerance`; it lasts at most `duration`.
/// @param first  acceleration at its start
Piece make_piece(const Slope& slope, const Vec2& place, const Vec2& v, const Vec2& first, double duration,
                 double tolerance) {
  Piece piece{first, duration};
  for (int halving = 0; halving < kMaxHalvings; ++halving) {
    const double half = 0.5 * piece.duration;
    piece.acceleration = slope.acceleration(place + half * v + 0.5 * half * half * first, v + half * first);
    const double error = 0.5 * (piece.acceleration - first).norm() * piece.duration * piece.duration;
    if (!(error > tolerance)) break;
    piece.duration *= std::clamp(0.9 * std::sqrt(tolerance / error), 0.1, 0.9);
  }
  return piece;
}

/// The edge at which a piece leaves its facet: the time, and the step to the next patch; no step at a crease.
struct EdgeAhead {
  double time;
  int columns = 0, rows = 0;
};

EdgeAhead edge_of(const Slope& slope, const Vec2& place, const Vec2& v, const Piece& piece) {
  const Eigen::Array2d per_cell(slope.surface.per_cell_x(), slope.surface.per_cell_y());
  const Vec2 rate = v.array() * per_cell, bend = 0.5 * piece.acceleration.array() * per_cell;
  const double p = slope.p_of(place), q = slope.q_of(place);
  EdgeAhead edge{std::numeric_limits<double>::infinity()};
  const auto meet = [&](double clearance, double f1, double f2, int columns, int rows) {
    if (f1 >= 0.0 && f2 >= 0.0) return;  // the block moves away from this edge
    const double time = first_contact(std::max(0.0, clearance), f1, f2, piece.duration);
    if (time < edge.time) edge = {time, columns, rows};
  };
  meet(p, rate.x(), bend.x(), -1, 0);
  meet(1.0 - p, -rate.x(), -bend.x(), 1, 0);
  meet(q, rate.y(), bend.y(), 0, -1);
  meet(1.0 - q, -rate.y(), -bend.y(), 0, 1);
  if (slope.crease != Crease::None) {
    const double inside = slope.north ? 1.0 : -1.0;
    meet(inside * across(slope.crease, p, q), inside * rate_across(slope.crease, rate.x(), rate.y()),
         inside * rate_across(slope.crease, bend.x(), bend.y()), 0, 0);
  }
  return edge;
}

/// Time until a piece leaves the cell at whose border it has to end [s]; infinite if it does not leave it.
double time_to_border(const Slope& slope, const Vec2& place, const Vec2& v, const Piece& piece) {
  const auto time = [&](bool far_half, double share, double rate, double bend) {
    const double inwards = far_half ? 1.0 : -1.0;
    return first_contact(std::max(0.0, inwards * (share - 0.5)), inwards * rate, inwards * bend, piece.duration);
  };
  const Vec2 bend = 0.5 * piece.acceleration;
  const double per_x = slope.surface.per_cell_x(), per_y = slope.surface.per_cell_y();
  return std::min(time(slope.bounded_to->east, slope.p_of(place), v.x() * per_x, bend.x() * per_x),
                  time(slope.bounded_to->north, slope.q_of(place), v.y() * per_y, bend.y() * per_y));
}

/// Reads the facet beyond an edge. Returns false if there is none.
bool read_beyond(const Slope& slope, const EdgeAhead& edge, const Motion& motion, Slope& beyond) {
  if (edge.columns == 0 && edge.rows == 0) return beyond.read(Facet{slope.at, !slope.north});
  beyond.at = {slope.at.column + edge.columns, slope.at.row + edge.rows};
  return beyond.read(motion.position.head<2>(), motion.velocity.head<2>());
}

/// Turns the velocity at an edge. If the surface rises, the block turns with it and keeps its speed; if the surface
/// falls away, the velocity stays. Returns whether the surface falls away.
bool turn(Vec3& velocity, const Vec3& normal) {
  const double speed = velocity.norm();
  const double away = velocity.dot(normal);
  if (away > kRounding * speed) return true;
  const Vec3 tangent = velocity - away * normal;
  const double length = tangent.norm();
  velocity = length > 0.0 ? Vec3(tangent * (speed / length)) : Vec3(Vec3::Zero());
  return false;
}

/// Whether a block takes off at an edge, onto the facet `beyond`. On a creased surface a hop of less than `tolerance`
/// is none: the block slides on. Else a block at the bottom of a pit of many facets would hop there without end.
bool takes_off(Vec3& velocity, const Slope& beyond, const Vec2& place, double tolerance) {
  const Vec3 normal = normal_of(beyond.gradient(place));
  if (!turn(velocity, normal)) return false;
  if (!beyond.surface.creased() || !(velocity.squaredNorm() < kGravity * tolerance)) return true;
  velocity -= velocity.dot(normal) * normal;
  return false;
}

/// The facet on which a slide starts. On a crease the block turns onto the half that it moves into.
Facet first_facet(const Surface& surface, PatchIndex at, Motion& motion) {
  Slope slope{surface, at, 0.0};
  const Vec2 place = motion.position.head<2>();
  if (!surface.creased() || !slope.read(place, motion.velocity.head<2>()) || slope.crease == Crease::None) return {at};
  if (std::abs(across(slope.crease, slope.p_of(place), slope.q_of(place))) <= kOnCrease)
    turn(motion.velocity, normal_of(slope.gradient(place)));
  return slope.index();
}

/// Result of one piece of sliding, to the end of the piece, of the facet or of the cell.
struct Step {
  Motion motion;
  EdgeAhead edge;
  bool crossed;
};

/// Height that the block would reach if all its energy of motion, but that of its spin, were turned into height [m].
double height_of_energy(const Motion& motion) {
  return motion.position.z() + motion.velocity.squaredNorm() / (2.0 * kGravity);
}

/// Rounding error of `height_of_energy` [m]: large at thousands of metres per second.
[[maybe_unused]] double rounding_of_energy(const Motion& motion) {
  return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(height_of_energy(motion));
}

/// Shortens a velocity to what a fall through this height gives: a piece is computed with one acceleration, and on
/// twisted ground the speed at its end would otherwise come out too large.
void slow_down(Vec3& velocity, double fall) {
  const double most = 2.0 * kGravity * std::max(0.0, fall), squared = velocity.squaredNorm();
  if (squared > most) velocity *= std::sqrt(most / squared);
}

/// One piece. It is shortened until its end is no higher than the energy of the block allows. A border of cells ends it
/// after the way of `tolerance` at the earliest: on a border it would otherwise have no length.
Step next_step(const Slope& slope, const Motion& motion, double farthest, double tolerance, double stop_speed) {
  const Vec2 place = motion.position.head<2>(), v = motion.velocity.head<2>(), gradient = slope.gradient(place);
  const double speed = motion.velocity.norm();
  const Vec2 first = sliding_acceleration(gradient, slope.twist(), v, slope.tan_phi);
  const Vec3 force = along(first, gradient);
  const double pull = speed > 0.0 ? motion.velocity.dot(force) / speed : force.norm();
  double longest = time_to_cover(farthest, speed, pull, kLongestPiece);
  if (pull < 0.0) {  // until friction holds it; on steep ground until it turns back, because friction turns too
    const double left = gradient.norm() <= slope.tan_phi ? std::max(0.0, speed - stop_speed) : speed;
    longest = std::min(longest, left / -pull + 1e-9);
  }
  const Piece piece = make_piece(slope, place, v, first, longest, tolerance);
  const EdgeAhead edge = edge_of(slope, place, v, piece);
  const auto place_after = [&](double t) -> Vec2 { return place + t * v + 0.5 * t * t * piece.acceleration; };
  const double border = slope.bounded_to ? std::max(time_to_border(slope, place, v, piece),
                                                    time_to_cover(tolerance, speed, pull, piece.duration))
                                         : std::numeric_limits<double>::infinity();
  const double whole = std::min({edge.time, border, piece.duration});
  const double top = height_of_energy(motion) + kHeightRounding;
  double dt = whole;
  for (int halving = 0; halving < kMaxHalvings && slope.height(place_after(dt)) > top; ++halving) dt *= 0.5;
  const Vec2 there = place_after(dt);
  Motion next = motion;
  next.time += dt;
  next.position = {there.x(), there.y(), std::min(slope.height(there), top)};  // at a corner two facets may differ
  next.velocity = along(v + dt * piece.acceleration, slope.gradient(there));
  slow_down(next.velocity, top - next.position.z());
  return {next, edge, dt == edge.time};
}

/// Whether friction alone would hold the block at rest on one of two patches that meet at its place. Otherwise they
/// hold it between them, as walls.
SlideEnd rest_between(const Slope& one, const Slope& other, const Motion& motion) {
  const auto holds = [&](const Slope& slope) {
    return slope.gradient(motion.position.head<2>()).norm() <= slope.tan_phi;
  };
  return holds(one) || holds(other) ? SlideEnd::Stopped : SlideEnd::Trapped;
}

}  // namespace

double time_to_cover(double distance, double s, double a, double longest) {
  return std::min(longest, first_contact(distance, -s, -0.5 * a, longest));
}

void record_piece(Path& path, const Slope& slope, const Motion& before, const Motion& after) {
  if (!(after.time > before.time)) return;
  path.vertices.push_back({before, Event::Slide});
  const Vec2 from = before.position.head<2>(), to = after.position.head<2>();
  path.spans.push_back({slope.at, static_cast<float>(slope.p_of(from)), static_cast<float>(slope.q_of(from)),
                        static_cast<float>(slope.p_of(to)), static_cast<float>(slope.q_of(to)), 0.0F, 0.0F, 0.0F, 0.0F,
                        static_cast<float>(before.velocity.norm()), static_cast<float>(after.velocity.norm()), 0});
  path.length += (after.position - before.position).norm();
  path.plan_length += (to - from).norm();
}

Eigen::Vector2d sliding_acceleration(const Eigen::Vector2d& slope, double twist, const Eigen::Vector2d& v,
                                     double tan_phi) {
  const double w2 = 1.0 + slope.squaredNorm();
  const double rise = slope.dot(v);
  const double speed = std::sqrt(v.squaredNorm() + rise * rise);
  const double press = kGravity + 2.0 * twist * v.x() * v.y();
  const double friction = tan_phi * kGravity / std::sqrt(w2);
  if (speed > 1e-9) return -press / w2 * slope - friction / speed * v;
  const double steepness = slope.norm();
  if (!(steepness > tan_phi)) return Eigen::Vector2d::Zero();
  return -(kGravity / w2) * (1.0 - tan_phi / steepness) * slope;
}

SlideEnd slide(const Surface& surface, const Cover& cover, Motion& motion, PatchIndex& at, WayToAsperity asperity,
               double stop_speed, Path& path, const RollingResistance* resistance) {
  auto [diameter, slid] = asperity;
  const double tolerance = kErrorShare * diameter, full = diameter * (1.0 - 1e-6);
  if (slid >= full) return SlideEnd::NextAsperity;
  SlidingFriction friction(cover, resistance);
  int short_crossings = 0;  // in succession, with less way than the tolerance between them
  Facet on = first_facet(surface, at, motion), came_from = on;
  for (int pieces = 0; pieces < kMaxPieces; ++pieces) {
    Slope slope{surface, at, 0.0};
    if (!slope.read(on)) return SlideEnd::Left;
    friction.set(slope, motion);
    const double tan_phi = slope.tan_phi, speed = motion.velocity.norm();
    if (speed <= stop_speed && slope.gradient(motion.position.head<2>()).norm() <= tan_phi) return SlideEnd::Stopped;
    if (!(slope.press(motion.velocity.head<2>()) >= 0.0)) return SlideEnd::Takeoff;

    const Step step = next_step(slope, motion, diameter - slid, tolerance, stop_speed);
    TALUS_EXPECT(step.motion.time >= motion.time, "a slide goes forward in time");
    TALUS_EXPECT(height_of_energy(step.motion) - height_of_energy(motion) <= 1e-9 + rounding_of_energy(motion),
                 "a slide does not gain energy");
    double way = 0.5 * (step.motion.time - motion.time) * (speed + step.motion.velocity.norm());
    record_piece(path, slope, motion, step.motion);
    motion = step.motion;
    if (step.crossed) {
      Slope beyond{surface, at, tan_phi};
      if (!read_beyond(slope, step.edge, motion, beyond)) return SlideEnd::Left;
      if (way < tolerance && beyond.index() == came_from) {  // pressed back at once: slides along the edge
        const Motion before = motion;
        if (slide_along_edge(slope, beyond, motion, diameter - slid, path) == EdgeEnd::Held)
          return rest_between(slope, beyond, motion);
        way += (motion.position - before.position).norm();
        on = slope.facet_at(motion.position.head<2>());  // from a corner it may have slid along the other half
      } else {
        came_from = on;
        on = beyond.index();
        at = on.at;
        if (takes_off(motion.velocity, beyond, motion.position.head<2>(), tolerance)) return SlideEnd::Takeoff;
      }
    }
    slid += way;
    if (slid >= full) return SlideEnd::NextAsperity;
    if (way >= tolerance) short_crossings = 0;
    if (step.crossed && way < tolerance &&
        ++short_crossings > kMaxShort) {  // a pit: it spends the time of the rest of one diameter there, at its speed
      motion.time += (diameter - slid) / std::max(stop_speed, motion.velocity.norm());
      if (motion.velocity.norm() > stop_speed) return SlideEnd::NextAsperity;
      Slope here{surface, at, tan_phi};
      return here.read(on) ? rest_between(slope, here, motion) : SlideEnd::Trapped;
    }
  }
  return SlideEnd::NextAsperity;
}

}  // namespace talus
