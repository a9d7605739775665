#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "talus/simulate/tally/hazard_tally.hpp"

namespace talus {

/// Something that blocks may hit: polygons with what they enclose, and lines [m, local].
struct HazardObject {
  using Ring = std::vector<Eigen::Vector2d>;
  std::vector<std::vector<Ring>> polygons;  ///< of each the outer ring, then holes
  std::vector<Ring> lines;
};

/// The trajectories that come to one object. Whole numbers only: equal bits for any number of threads.
struct ObjectHits {
  HazardCell cell;
  std::map<std::uint32_t, std::int64_t> by_feature;  ///< weight of those from each feature [WeightScale::unit]
  std::uint64_t trajectories = 0;

  void merge(const ObjectHits& other);
};

/// Runs a plan again, trajectory by trajectory with the same bits, and finds what comes to each object.
///
/// A block comes to an object where the distance in plan between its path and the object is at most its radius, at any
/// height above the ground. Its energy there is the largest on the pieces of its path, at most one cell long, that come
/// so near. A block that breaks counts once, with the largest energy of its pieces.
///
/// @param proceed  called with the share done, 0..1; false ends it. From any thread, one at a time
/// @param threads  0: as many as the machine has
/// @return by object; nothing where it was ended
std::vector<ObjectHits> replay_objects(const Scenario& scenario, const AnnualWeights& weights,
                                       std::span<const HazardObject> objects,
                                       const std::function<bool(double)>& proceed, int threads);

}  // namespace talus
