#pragma once
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "talus/simulate/tally/hazard_tally.hpp"

namespace talus {

/// An object that blocks may hit: polygons with their interior, and lines [m, local].
struct HazardObject {
  using Ring = std::vector<Eigen::Vector2d>;
  std::vector<std::vector<Ring>> polygons;  ///< each: its outer ring, then its holes
  std::vector<Ring> lines;
  double line_width = 0.0;  ///< of its lines: a road, a track [m]
};

/// The trajectories that hit one object. Whole numbers only: equal bits for any number of threads.
struct ObjectHits {
  HazardCell largest;                                ///< by the largest energy while the block touches the object
  HazardCell entry;                                  ///< by the largest of the energies where it first touches a part
  std::map<std::uint32_t, std::int64_t> by_feature;  ///< weight from each feature [WeightScale::unit]
  std::uint64_t trajectories = 0;

  void merge(const ObjectHits& other);
};

/// Traces a plan again with the same bits, and finds which trajectories hit each object.
///
/// A block hits an object if the distance in plan between its path and the object is at most its radius, at any height
/// above the ground; a line is half its width nearer. The energies are those on this part of the path, exact: where it
/// begins, and the largest from where it begins to where it ends within each patch. A block that breaks counts once,
/// with the largest energies of its pieces.
///
/// @param objects  must outlive the call
/// @param proceed  called with the share done, 0..1; false ends the run. From any thread, one at a time
/// @param threads  0: as many as the machine has
/// @return hits of each object; empty if `proceed` ended the run
std::vector<ObjectHits> replay_objects(const Scenario& scenario, const AnnualWeights& weights,
                                       std::span<const HazardObject> objects,
                                       const std::function<bool(double)>& proceed, int threads);

}  // namespace talus
