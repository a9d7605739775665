#pragma once
#include <algorithm>
#include <optional>

#include "talus/base/bounds.hpp"
#include "talus/physics/barriers.hpp"
#include "talus/physics/flight.hpp"
#include "talus/physics/slide.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// What barriers do to a block at one place: one catches it, or those that stand there break.
struct BarrierMet {
  Meeting how;
  double share;              ///< of the way, at which the leg ends
  double taken;              ///< energy that the broken ones took [J]
  std::size_t first_of_leg;  ///< index among the meetings of the path of the first one on this way
};

/// Checks each leg of a path (a flight or a slide) for barriers, after it was added to the path. If a barrier catches
/// the block or breaks, the leg is cut off at the barrier. A leg without this is unchanged to the last bit.
class BarrierWatch {
 public:
  explicit BarrierWatch(const World& world) : world_(world) {}

  /// Starts a leg at vertex `first`, which exists or is the next to be added.
  void begin(const Path& path, std::size_t first);

  /// Checks the leg that ended at `motion`. Over: the leg is unchanged. Otherwise the path, `motion` and `at` end at
  /// the barrier. Caught: the block is at rest, a millimetre before the line. Broken: the block is on the line, with
  /// the rest of its speed in the same direction, and the path has a vertex there.
  Meeting look(Motion& motion, PatchIndex& at, const Block& body, Path& path);

  /// The first barrier on a straight way in plan from `a` to `b` that acts on the block. Adds the meetings to the path.
  ///
  /// @param motion_at  motion of the block at a share of the way
  template <class MotionAt>
  std::optional<BarrierMet> first(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Block& body, Path& path,
                                  const MotionAt& motion_at) const {
    // On the line of one that broke, rounding decides on which side of others on the same line `a` lies.
    const double way = (b - a).norm(), back = a == broken_at_ && way > 0.0 ? kOneLine : 0.0;
    const Eigen::Vector2d from = back > 0.0 ? Eigen::Vector2d(a - back / way * (b - a)) : a;
    const std::size_t before = path.barriers.size();
    std::optional<BarrierMet> broken;
    std::optional<Barriers::Cut> cut;
    while ((cut = world_.barriers->next(from, b, cut))) {
      const double share = back > 0.0 ? std::max(0.0, cut->share * (way + back) - back) / way : cut->share;
      if (broken && (share - broken->share) * way > kOneLine) break;
      if (back > 0.0 && share * way <= kOneLine && was_met_here(cut->barrier, path)) continue;
      const double taken = broken ? broken->taken : 0.0;
      const Meeting how = meet(*cut, motion_at(share), body, taken, path);
      if (how == Meeting::Caught) return BarrierMet{how, std::max(0.0, share - kGap / way), taken, before};
      if (how == Meeting::Broken)
        broken = BarrierMet{how, broken ? broken->share : share, taken + capacity_of(*cut), before};
    }
    return broken;
  }
  /// Stops the block at a barrier that catches it, or slows it down by what broken ones take, and adds a vertex.
  ///
  /// @param motion  of the block at the barrier, where its leg and its path end
  void act(const BarrierMet& met, const Block& body, Motion& motion, Path& path);

 private:
  Meeting look(std::size_t vertex, const Vertex& to, Motion& motion, const Block& body, Path& path);
  /// @param taken  energy that barriers on the same line took before [J]
  Meeting meet(const Barriers::Cut& cut, const Motion& there, const Block& body, double taken, Path& path) const;
  double capacity_of(const Barriers::Cut& cut) const { return world_.barriers->list()[cut.barrier].capacity; }
  /// Whether a barrier was met where the last one broke.
  bool was_met_here(std::uint32_t barrier, const Path& path) const;
  double ground_at(const Vec3& place) const;
  void cut_off(std::size_t vertex, const Vertex& to, double share, Path& path) const;

  static constexpr double kGap = 1e-3;  // between a block that is caught and the line, along its way [m]

  const World& world_;
  std::size_t first_vertex_ = 0, first_span_ = 0;
  double length_ = 0.0, plan_length_ = 0.0;                           // of the path before the leg [m]
  Eigen::Vector2d broken_at_ = Eigen::Vector2d::Constant(kNotGiven);  // where a barrier broke last
  std::size_t met_here_ = 0;  // the meetings of the path from this one on: the way from there does not meet them again
};

/// The engine with barriers: `Acting`, with a BarrierWatch on its flights and slides. Flights with drag or stems end at
/// barriers by themselves.
template <class Acting>
class BehindBarriers : public Acting {
 public:
  BehindBarriers(const World& world, const Release& release) : Acting(world, release), watch_(world) {}

  FlightEnd fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path) {
    if constexpr (requires { this->drag_flight(); })
      if (auto* drag = this->drag_flight()) return drag->fly(motion, at, grounded, body, path, &watch_);
    for (int legs = 0; legs < kMostLegs; ++legs) {
      watch_.begin(path, path.vertices.size() - 1);
      const FlightEnd end = Acting::fly(motion, at, grounded, body, path);
      const Meeting met = watch_.look(motion, at, body, path);
      if (met == Meeting::Over) return end;
      if (met == Meeting::Caught) return FlightEnd::Caught;
      grounded = false;
    }
    return FlightEnd::Aloft;
  }

  SlideEnd slide(Motion& motion, PatchIndex& at, const Block& body, Path& path) {
    const double length = path.length;
    for (int legs = 0; legs < kMostLegs; ++legs) {
      watch_.begin(path, path.vertices.size());
      const SlideEnd end = Acting::slide(motion, at, body, path, path.length - length);
      const Meeting met = watch_.look(motion, at, body, path);
      if (met == Meeting::Over) return end;
      if (met == Meeting::Caught) return SlideEnd::Caught;
    }
    return SlideEnd::NextAsperity;
  }

 private:
  static constexpr int kMostLegs = 10'000;  // most barriers broken in one flight or slide
  BarrierWatch watch_;
};

}  // namespace talus
