#pragma once
#include <limits>

#include "talus/physics/flight.hpp"
#include "talus/physics/slide.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// Looks for barriers on each leg of a path: a flight or a slide, as soon as it is in the path. Where one holds the
/// block, or breaks, the leg is cut off there; nothing else changes a bit.
class BarrierWatch {
 public:
  explicit BarrierWatch(const World& world) : world_(world) {}

  /// Remembers where the leg begins: at vertex `first`, which is there or comes next.
  void begin(const Path& path, std::size_t first);

  /// What a barrier does to the leg that ended at `motion`: Over where it is as it was. Else the path ends at the
  /// barrier, and `motion` and `at` are there: Caught, at rest a millimetre before it; Broken, on the line with what is
  /// left of the speed, the direction kept, a vertex of it in the path.
  Meeting look(Motion& motion, PatchIndex& at, const Block& body, Path& path);

 private:
  Meeting look(std::size_t vertex, const Vertex& to, Motion& motion, const Block& body, Path& path);
  void cut_off(std::size_t vertex, const Vertex& to, double share, Path& path) const;

  const World& world_;
  std::size_t first_vertex_ = 0, first_span_ = 0;
  double length_ = 0.0, plan_length_ = 0.0;                              // of the path before the leg [m]
  std::uint32_t broken_ = std::numeric_limits<std::uint32_t>::max();     // segment that broke last, and where:
  Eigen::Vector2d broken_at_ = Eigen::Vector2d::Constant(std::nan(""));  // the way on from there does not cross it
};

/// What a trajectory goes through where there are barriers: as `Acting`, its flights and slides watched.
template <class Acting>
class BehindBarriers : public Acting {
 public:
  BehindBarriers(const World& world, const Release& release) : Acting(world, release), watch_(world) {}

  Outcome fly(Motion& motion, PatchIndex& at, bool grounded, const Block& body, Path& path) {
    for (int legs = 0; legs < kMostLegs; ++legs) {
      watch_.begin(path, path.vertices.size() - 1);
      const Outcome outcome = Acting::fly(motion, at, grounded, body, path);
      const Meeting met = watch_.look(motion, at, body, path);
      if (met == Meeting::Over) return outcome;
      if (met == Meeting::Caught) return Outcome::Caught;
      grounded = false;
    }
    return Outcome::Aloft;
  }

  SlideEnd slide(Motion& motion, PatchIndex& at, const Block& body, Path& path) {
    for (int legs = 0; legs < kMostLegs; ++legs) {
      watch_.begin(path, path.vertices.size());
      const SlideEnd end = Acting::slide(motion, at, body, path);
      const Meeting met = watch_.look(motion, at, body, path);
      if (met == Meeting::Over) return end;
      if (met == Meeting::Caught) return SlideEnd::Caught;
    }
    return SlideEnd::Asperity;
  }

 private:
  static constexpr int kMostLegs = 10'000;  // barriers broken in one flight or slide
  BarrierWatch watch_;
};

}  // namespace talus
