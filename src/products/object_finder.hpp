#pragma once
#include <algorithm>
#include <optional>
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
  float entry = -1.0F;    ///< where it first touches a part of the object; of several parts the largest

  /// Adds what another piece of the same block meets: the larger energies count.
  void raise(const ObjectContact& piece) {
    largest = std::max(largest, piece.largest);
    entry = std::max(entry, piece.entry);
  }
};

/// Finds which objects a path meets, and with which energy. Each patch has a list of the objects near it, so most
/// patches need no further test.
///
/// A block meets what its rim touches. Two touches of the rim alone do not count: of a part of an object that the block
/// lay beside when it was released, until the rim has left it; and of a part behind the barrier that catches the block,
/// from where the rim reaches it.
class ObjectFinder {
 public:
  /// @param barriers  of the run: its paths end `caught` at them
  /// @param radius    of the largest block [m]
  /// @param with_rotation  energies count the rotation; else they are translational
  ObjectFinder(const Surface& surface, const Barriers& barriers, std::span<const HazardObject> objects, double radius,
               bool with_rotation = false);

  /// Adds what a path meets.
  void add(const Path& path, const Block& body, std::span<ObjectContact> contacts) const;

 private:
  void enter(std::uint32_t object, double radius);
  /// A polygon or a line of an object.
  struct PartOfObject {
    std::uint32_t object;
    std::size_t part;
    bool operator==(const PartOfObject&) const = default;
  };
  /// A place on a path: a share of one of its spans.
  struct PlaceOnPath {
    std::size_t span = 0;
    double share = 0.0;
  };
  /// From where, and up to where, the rim of the block counts, for the parts where it does not all along the path.
  struct RimLimits {
    std::vector<std::pair<PartOfObject, PlaceOnPath>> begin, end;
    /// The shares of a span between which it counts.
    std::pair<double, double> of_rim(const PartOfObject& part, std::size_t span) const;
  };

  Way way_of(const Span& span) const;
  std::span<const std::uint32_t> objects_near(const Span& span) const;
  template <class Visit>
  void for_each_part(const Span& span, Visit visit) const;
  bool only_rim_touches(const PartOfObject& part, const Eigen::Vector2d& place, double radius) const;
  /// Whether a barrier stands between the place where it caught a block and the nearest place of the part.
  bool stands_behind(const PartOfObject& part, const Eigen::Vector2d& caught) const;
  RimLimits limits_of(const Path& path, const Block& first, const Block& last) const;
  std::optional<Touch> touch_in(std::size_t span, const Way& way, const PartOfObject& part, double radius,
                                const RimLimits& limits) const;

  const Surface& surface_;
  const Barriers& barriers_;
  std::span<const HazardObject> objects_;
  bool with_rotation_;
  Raster<std::int32_t> near_;  // by patch: 0, or 1 + the index of its list
  std::vector<std::vector<std::uint32_t>> lists_;
};

/// The part of a way, from its first to its last share, on which a block of a radius touches an object in plan.
std::optional<Touch> touch_of(const Way& way, const HazardObject& object, double radius);

}  // namespace talus
