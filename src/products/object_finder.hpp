#pragma once
#include <algorithm>
#include <span>
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

/// Finds which objects a path meets, and with which energy. Each patch has a list of the objects near it, so most
/// patches need no further test.
class ObjectFinder {
 public:
  /// @param radius  of the largest block [m]
  ObjectFinder(const Surface& surface, std::span<const HazardObject> objects, double radius);

  /// Adds what a path meets.
  void add(const Path& path, const Block& body, std::span<ObjectContact> contacts) const;

 private:
  void enter(std::uint32_t object, double radius);
  void add(std::span<const Span> spans, const Block& body, std::span<ObjectContact> contacts) const;

  const Surface& surface_;
  std::span<const HazardObject> objects_;
  Raster<std::int32_t> near_;  // by patch: 0, or 1 + the index of its list
  std::vector<std::vector<std::uint32_t>> lists_;
};

/// The part of a way, from its first to its last share, on which a block of a radius touches an object in plan.
std::optional<Touch> touch_of(const Way& way, const HazardObject& object, double radius);

}  // namespace talus
