#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "talus/simulate/tally/hazard_tally.hpp"

namespace talus {

/// An object that blocks may hit: polygons with their interior, and lines [m, local].
struct HazardObject {
  using Ring = std::vector<Eigen::Vector2d>;
  std::vector<std::vector<Ring>> polygons;  ///< each: its outer ring, then its holes
  std::vector<Ring> lines;
};

/// The trajectories that hit one object. Whole numbers only: equal bits for any number of threads.
struct ObjectHits {
  HazardCell cell;
  std::map<std::uint32_t, std::int64_t> by_feature;  ///< weight from each feature [WeightScale::unit]
  std::uint64_t trajectories = 0;

  void merge(const ObjectHits& other);
};

/// Traces a plan again with the same bits, and finds which trajectories hit each object.
///
/// A block hits an object if the distance in plan between its path and the object is at most its radius, at any height
/// above the ground. Its path is divided into spans of at most one cell; its energy at the object is the largest on the
/// spans that are so near. A block that breaks counts once, with the largest energy of its pieces.
///
/// @param proceed  called with the share done, 0..1; false ends the run. From any thread, one at a time
/// @param threads  0: as many as the machine has
/// @return hits of each object; empty if `proceed` ended the run
std::vector<ObjectHits> replay_objects(const Scenario& scenario, const AnnualWeights& weights,
                                       std::span<const HazardObject> objects,
                                       const std::function<bool(double)>& proceed, int threads);

}  // namespace talus
