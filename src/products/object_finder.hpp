#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "talus/physics/path.hpp"
#include "talus/products/objects.hpp"
#include "touch.hpp"

namespace talus {

/// Energies of a block at an object [kJ]; negative: it does not meet it.
struct ObjectContact {
  float largest = -1.0F;  ///< on the part of its path that touches the object
  float entry = -1.0F;    ///< where it first touches the object

  /// Adds what another piece of the same block meets: the larger energies count.
  void raise(const ObjectContact& piece) {
    largest = std::max(largest, piece.largest);
    entry = std::max(entry, piece.entry);
  }
};

/// A part of a span, from one share to another.
struct Stretch {
  double from = 0.0, to = 1.0;
};

/// Finds which objects a path meets, and with which energy. Each patch has a list of the objects near it, so most
/// patches need no further test.
///
/// A block meets what its rim touches. But what only its rim touches at its release, it lay beside; and what only its
/// rim touches where a barrier catches it, stands behind the barrier. Such an object is met from where the rim has left
/// it, or up to where the rim reaches it; else only by the centre.
class ObjectFinder {
 public:
  /// @param radius  of the largest block [m]
  ObjectFinder(const Surface& surface, std::span<const HazardObject> objects, double radius);

  /// Adds what a path meets.
  void add(const Path& path, const Block& body, std::span<ObjectContact> contacts) const;

 private:
  void enter(std::uint32_t object, double radius);
  /// A place on a path: a share of one of its spans.
  struct PlaceOnPath {
    std::size_t span = 0;
    double share = 0.0;
  };
  /// From where to where the rim of a block counts, for the objects where it does not all along the path.
  struct RimLimits {
    std::vector<std::pair<std::uint32_t, PlaceOnPath>> begin, end;
    Stretch of_rim(std::uint32_t object, std::size_t span) const;
  };

  Way way_of(const Span& span) const;
  std::span<const std::uint32_t> objects_near(const Span& span) const;
  bool only_rim_touches(std::uint32_t object, const Eigen::Vector2d& place, double radius) const;
  RimLimits limits_of(const Path& path, const Block& first, const Block& last) const;
  void add(const Way& way, const Stretch& part, double radius, std::uint32_t object, const Span& span,
           const Block& body, ObjectContact& contact) const;

  const Surface& surface_;
  std::span<const HazardObject> objects_;
  Raster<std::int32_t> near_;  // by patch: 0, or 1 + the index of its list
  std::vector<std::vector<std::uint32_t>> lists_;
};

/// The part of a way, from its first to its last share, on which a block of a radius touches an object in plan.
std::optional<Touch> touch_of(const Way& way, const HazardObject& object, double radius);

}  // namespace talus
