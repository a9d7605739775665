#include "drag_flight.hpp"

#include <algorithm>
#include <cmath>

#include "barrier_watch.hpp"

namespace talus {
namespace {

constexpr double kShortestPiece = 0.01;  // [s]
constexpr int kMostSteps = 1'000'000;    // pieces of one flight; the time limit comes first

double plan_squared(const Vec3& velocity) {
  return velocity.x() * velocity.x() + velocity.y() * velocity.y();
}

/// A straight way in plan from a place in the direction of a vector; no heading where that has none in plan.
PlanWay plan_way(const Vec3& from, const Vec3& direction, double length) {
  const Eigen::Vector2d along = direction.head<2>();
  const double size = along.norm();
  PlanWay way{from.head<2>(), Eigen::Vector2d::Zero(), length};
  if (size > 0.0) way.heading = along / size;
  return way;
}

/// Constant drag rates that do in a piece what drag does [1/s].
struct PieceRates {
  double way = 0.0;    ///< shortens the way as much
  double speed = 0.0;  ///< takes as much speed
};

/// Rates of a piece. Drag takes the speed (linear + quadratic v) v dt, so the rate for the speed is that of the mean of
/// v^2 over the mean of v. For the way each loss counts by the time that is left of the piece. Both means are by
/// Simpson's rule, with the speeds at the start, in the middle and at the end, to first order in time. Where drag is
/// linear, both rates are exact.
PieceRates rates_of_piece(const Vec3& velocity, const DragRate& drag, double time) {
  if (!drag.any()) return {};
  const Vec3 braking = drag.at(velocity.norm()) * velocity + Vec3(0.0, 0.0, kGravity);
  const double first = velocity.norm(), middle = (velocity - 0.5 * time * braking).norm(),
               last = (velocity - time * braking).norm();
  if (!(first + middle > 0.0)) return {drag.linear, drag.linear};
  const double first2 = first * first, middle2 = middle * middle, last2 = last * last;
  return {drag.at((first2 + 2.0 * middle2) / (first + 2.0 * middle)),
          drag.at((first2 + 4.0 * middle2 + last2) / (first + 4.0 * middle + last))};
}

}  // namespace

DragFlight::DragFlight(const World& world, const Release& release) : world_(world), effects_(*world.effects) {
  if (effects_.forest_stems.density > 0.0)
    stems_.emplace(effects_.forest_stems,
                   Random(release.seed, release.source, release.block, Purpose::Stem, release.piece));
}

DragFlight::Site DragFlight::site_of(const Motion& motion, const Block& body) const {
  Site site{{0.0, air_drag_rate(effects_.air_drag, body)}, false};
  const double x = motion.position.x(), y = motion.position.y();
  const std::optional<double> ground = world_.surface.height(x, y);
  if (!ground) return site;
  const double clearance = motion.position.z() - *ground;
  const std::uint8_t zone = world_.cover.zone_at(x, y);
  if (effects_.vegetation_drag.where.covers(zone, x, y))
    site.drag.linear = vegetation_drag_rate(effects_.vegetation_drag, body.mass, clearance);
  const ForestStems& forest = effects_.forest_stems;
  site.stems = stems_ && (stems_->of_list() || (clearance < forest.height && forest.where.covers(zone, x, y)));
  return site;
}

bool DragFlight::below_the_tops(const Vec3& position) const {
  const std::optional<double> ground = world_.surface.height(position.x(), position.y());
  return ground && position.z() - *ground < effects_.forest_stems.height;
}

/// Ends a way in plan inside a stand: if it has led to a stem, the block hits it. Returns whether.
bool DragFlight::meet_stem(const PlanWay& gone, const Block& body, Motion& motion) {
  if (stems_->of_list() && !below_the_tops(motion.position)) {
    stems_->pass_over();
    return false;
  }
  motion.velocity = stems_->hit(gone, motion.velocity, body.mass);
  return true;
}

double DragFlight::longest_piece(const Site& site, const Motion& motion) const {
  const Grid& grid = world_.surface.grid();
  const double cell = std::min(grid.cell_x, grid.cell_y), speed = motion.velocity.norm();
  const double over_a_cell = 2.0 * cell / (speed + std::sqrt(speed * speed + 2.0 * kGravity * cell));  // in a fall
  const double rate = site.drag.at(speed + kGravity * over_a_cell);
  return std::max(kShortestPiece, std::min(over_a_cell, world_.effort.drag_loss / rate));
}

/// A piece of a flight. One that ends early, at the ground or at a barrier, is flown again: the parabola and the drag
/// rates were those of a longer piece. The error left in the time to there is of second order in the drag.
struct DragFlight::Piece {
  Motion start;
  PatchIndex start_at;
  bool grounded;
  DragRate drag;
  std::size_t first_span;
  double length, plan_length;  // of the path before
  PieceRates rate = {};
  Vec3 began = Vec3::Zero();  // velocity of the parabola at its start

  PieceRates rates(double time) const { return rates_of_piece(start.velocity, drag, time); }
  Vec3 parabola(double time) const { return DampedFall(rates(time).way, time).parabola(start.velocity); }

  /// Flies it with the rates of this time [s], for at most `longest`.
  FlightEnd fly(const Surface& surface, double time, double longest, Motion& motion, PatchIndex& at, Path& path) {
    motion = start, at = start_at;
    path.spans.resize(first_span), path.length = length, path.plan_length = plan_length;
    rate = rates(time);
    began = DampedFall(rate.way, time).parabola(start.velocity);
    motion.velocity = began;
    return talus::fly(surface, motion, at, grounded, path, longest);
  }
  /// Time of a piece that ends after this way in plan [s], at most `longest`. Halved until no digit is left.
  double time_to(double way, double longest) const {
    double low = 0.0, high = longest;
    for (int halving = 0; halving < 64; ++halving) {
      const double time = 0.5 * (low + high);
      (time * std::sqrt(plan_squared(parabola(time))) < way ? low : high) = time;
    }
    return high;
  }
  /// Motion at the end of a piece of this time [s].
  Motion after(double time) const {
    Motion motion = start;
    motion.time += time;
    motion.position += time * parabola(time) - Vec3(0.0, 0.0, 0.5 * kGravity * time * time);
    motion.velocity = DampedFall(rates(time).speed, time).velocity_after(start.velocity);
    return motion;
  }
};

/// Ends a piece at the first barrier that acts on the block, with the speed of the block there.
std::optional<BarrierMet> DragFlight::end_at_barrier(const BarrierWatch& watch, Piece& piece, FlightEnd& end,
                                                     Motion& motion, PatchIndex& at, const Block& body,
                                                     Path& path) const {
  const double way = (motion.position - piece.start.position).head<2>().norm(),
               longest = motion.time - piece.start.time;
  const auto met = watch.first(piece.start.position.head<2>(), motion.position.head<2>(), body, path,
                               [&](double share) { return piece.after(piece.time_to(share * way, longest)); });
  if (!met) return met;
  const double time = piece.time_to(met->share * way, longest);
  end = piece.fly(world_.surface, time, time, motion, at, path);
  return met;
}

FlightEnd DragFlight::fly_piece(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path,
                                BarrierWatch* watch) {
  const Motion start = motion;
  const Site site = site_of(motion, body);
  double time = longest_piece(site, motion);
  if (site.stems) {
    const double speed = std::sqrt(plan_squared(motion.velocity));
    time = std::min(time,
                    stems_->way_left(plan_way(motion.position, motion.velocity, speed * time), body.diameter) / speed);
  }
  Piece piece{start, at, grounded, site.drag, path.spans.size(), path.length, path.plan_length};
  FlightEnd end = piece.fly(world_.surface, time, time, motion, at, path);
  if (piece.rate.way > 0.0 && end == FlightEnd::Landed)
    end = piece.fly(world_.surface, motion.time - start.time, time, motion, at, path);
  std::optional<BarrierMet> met;
  if (watch != nullptr) met = end_at_barrier(*watch, piece, end, motion, at, body, path);

  if (piece.began != start.velocity || path.vertices.back().motion.time != start.time) {
    path.vertices.push_back({start, Event::Air});
    path.vertices.back().motion.velocity = piece.began;
  }
  if (piece.rate.way > 0.0) {
    motion.velocity = DampedFall(piece.rate.speed, motion.time - start.time).velocity_after(start.velocity);
    if (path.spans.size() > piece.first_span) {  // speeds at the ends are those of the block, not of its parabola
      path.spans[piece.first_span].plan_speed_squared = static_cast<float>(plan_squared(start.velocity));
      path.spans[piece.first_span].rise_from = static_cast<float>(start.velocity.z());
      path.spans.back().rise_to = static_cast<float>(motion.velocity.z());
    }
  }
  const PlanWay gone = plan_way(start.position, start.velocity, (motion.position - start.position).head<2>().norm());
  const bool at_stem = site.stems && stems_->go(gone, body.diameter);
  if (met) {  // a stem at the same place is met by the next piece
    watch->act(*met, body, motion, path);
    return met->how == Meeting::Caught ? FlightEnd::Caught : end;
  }
  if (at_stem && end == FlightEnd::Aloft && meet_stem(gone, body, motion))
    path.vertices.push_back({motion, Event::Stem});
  return end;
}

bool DragFlight::in_a_stand(const PatchIndex& patch) const {
  const Grid& grid = world_.surface.grid();
  if (patch.column < 0 || patch.row < 0 || patch.column + 1 >= grid.columns || patch.row + 1 >= grid.rows) return true;
  for (const int column : {patch.column, patch.column + 1})
    for (const int row : {patch.row, patch.row + 1}) {
      const double x = grid.centre_x(column), y = grid.centre_y(row);
      const std::uint8_t zone = world_.cover.zone_at(x, y);
      if (effects_.vegetation_drag.coefficient > 0.0 && effects_.vegetation_drag.where.covers(zone, x, y)) return true;
      if (stems_ && !stems_->of_list() && has_stand(effects_.forest_stems, zone, x, y)) return true;
    }
  return false;
}

/// The plain flight to the ground or to a barrier, `Aloft` behind one that broke, if it touches no cell of a stand and
/// no listed tree. Otherwise empty, and nothing is changed.
std::optional<FlightEnd> DragFlight::fly_clear(Motion& motion, PatchIndex& at, bool grounded, const Block& body,
                                               Path& path, BarrierWatch* watch) {
  if (in_a_stand(at)) return std::nullopt;
  if (watch != nullptr) watch->begin(path, path.vertices.size() - 1);
  Motion landed = motion;
  PatchIndex landed_at = at;
  const std::size_t first_span = path.spans.size();
  const double length = path.length, plan_length = path.plan_length;
  const FlightEnd end = talus::fly(world_.surface, landed, landed_at, grounded, path);
  const double way = (landed.position - motion.position).head<2>().norm();
  bool met = stems_ && stems_->of_list() &&
             stems_->way_left(plan_way(motion.position, motion.velocity, way), body.diameter) <= way;
  for (std::size_t i = first_span; !met && i < path.spans.size(); ++i) met = in_a_stand(path.spans[i].patch);
  if (met) {
    path.spans.resize(first_span), path.length = length, path.plan_length = plan_length;
    return std::nullopt;
  }
  motion = landed, at = landed_at;
  const Meeting how = watch == nullptr ? Meeting::Over : watch->look(motion, at, body, path);
  if (how == Meeting::Over) return end;
  return how == Meeting::Caught ? FlightEnd::Caught : FlightEnd::Aloft;
}

FlightEnd DragFlight::fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path,
                          BarrierWatch* watch) {
  bool may_be_clear = effects_.air_drag.coefficient == 0.0;
  for (int pieces = 0; pieces < kMostSteps && motion.time < world_.rules.time_limit &&
                       path.vertices.size() < world_.effort.most_vertices;
       ++pieces) {
    std::optional<FlightEnd> end;
    if (may_be_clear) end = fly_clear(motion, at, grounded, body, path, watch);
    if (!end) {
      end = fly_piece(motion, at, grounded, body, path, watch);
      may_be_clear = may_be_clear && stems_ && stems_->of_list() && path.vertices.back().event == Event::Stem;
    }
    if (*end != FlightEnd::Aloft) return *end;
    grounded = false;
  }
  return FlightEnd::Aloft;
}

void DragFlight::after_slide(const Motion& before, const Block& body, Motion& motion, Path& path) {
  const Site site = site_of(before, body);
  if (site.drag.any())
    motion.velocity *= exponential(-site.drag.at(motion.velocity.norm()) * (motion.time - before.time));
  if (!site.stems) return;
  const Vec3 slid = motion.position - before.position;
  const PlanWay gone = plan_way(before.position, slid, slid.head<2>().norm());
  stems_->way_left(gone, body.diameter);
  if (stems_->go(gone, body.diameter) && meet_stem(gone, body, motion)) path.vertices.push_back({motion, Event::Stem});
}

}  // namespace talus
