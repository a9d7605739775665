#pragma once
#include <memory>
#include <optional>

#include "talus/base/random.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/effects/tree_list.hpp"

namespace talus {

/// A forest that is not the same everywhere: rasters on the grid of the DEM, or single trees.
struct ForestMap {
  Raster<float> density;   ///< [stems per hectare]; empty: the number of the effect
  Raster<float> diameter;  ///< DBH [m]; empty: the number of the effect
  TreeList trees;          ///< if there are any, they are all that stands

  bool by_cell() const { return !density.values.empty() || !diameter.values.empty(); }
};

/// Stems: met at random in a stand, or the trees of a list.
struct ForestStems {
  static constexpr bool kLeavesPlane = true;
  double density = 0.0;         ///< [stems per hectare]; 0: off
  double diameter = 0.3;        ///< DBH [m]
  double height = 20.0;         ///< of the trees [m]
  double species_factor = 1.0;  ///< factor on the energy a stem takes; 1: silver fir [-]
  EffectArea where;
  std::shared_ptr<const ForestMap> map = nullptr;  ///< null: one stand

  bool lists_trees() const { return map != nullptr && !map->trees.empty(); }
  bool by_cell() const { return map != nullptr && map->by_cell(); }
};

/// forest-stems. docs/effects.md, "forest-stems".

/// The stand at a place.
struct Stand {
  double density;   ///< [stems per hectare]
  double diameter;  ///< DBH [m]
  bool operator==(const Stand&) const = default;
};

/// The stand of a cell; density 0 off the grid. Without rasters the numbers of the effect.
Stand stand_in(const ForestStems& forest, int column, int row);

/// Whether there is a forest in the cell at a place: in the area of the effect, with a density above 0. Not for lists.
bool has_stand(const ForestStems& forest, std::uint8_t zone, double x, double y);

/// Mean free path in plan between two stems [m]: 10 000 / (N (DBH + D)), N per hectare.
inline double mean_free_path(const Stand& stand, double diameter) {
  return 1e4 / (stand.density * (stand.diameter + diameter));
}

/// The most energy that a stem can take [J]: factor 38.7 DBH^2.31, DBH in cm. Source: Dorren & Berger (2006).
///
/// @param diameter  DBH [m]
double stem_capacity(double diameter, double factor);

/// Share of this energy that a stem takes at a hit with eccentricity e: 0.98 at 0 (middle), 0 at -1 and 1 (edge).
/// Source: the sigmoid of Dorren & Berger (2006), made symmetric and cut at 0.
double stem_share(double eccentricity);

/// Velocity of a block after a stem took energy from it.
///
/// @param taken         energy per mass [J/kg], at most 1/2 v^2
/// @param eccentricity  e in (-1, 1): > 0 if the axis of the stem is left of the way
///
/// The speed becomes sqrt(v^2 - 2 taken). In plan the way turns away from the stem as if the impulse went through its
/// axis: only the part of the speed towards the axis, at the angle asin(e) from the way, decreases.
Vec3 velocity_after_stem(const Vec3& velocity, double taken, double eccentricity);

/// The stems that one block meets: in a stand at random, by number (a draw does not depend on the results of earlier
/// hits); of a list the trees on its way.
class Stems {
 public:
  Stems(const ForestStems& forest, const Random& random);

  bool of_list() const { return forest_.lists_trees(); }
  /// Way in plan inside the stand to the next stem [m]; may be infinite if it is not on this way.
  double way_left(const PlanWay& ahead, double diameter);
  /// Moves the block by a way in plan inside the stand. Returns whether it reached the next stem, that of the last call
  /// of `way_left` if the trees are listed.
  bool go(const PlanWay& gone, double diameter);
  /// Velocity after a hit on the next stem at the end of `gone`; then draws the stem after it.
  Vec3 hit(const PlanWay& gone, const Vec3& velocity, double mass);
  /// Passes the tree that was reached, above its top. Only for lists.
  void pass_over() { touched_.add(ahead_->tree); }

 private:
  void draw();
  double capacity_at(const PlanWay& gone) const;  // of the next stem [J]

  const ForestStems& forest_;
  Random random_;
  std::uint32_t number_ = 0;  // of the next stem
  double left_ = 0.0;         // way to it, as a multiple of the mean way
  double eccentricity_ = 0.0;
  double capacity_;                   // of a stem with the diameter of the effect [J]
  std::optional<TreeMeeting> ahead_;  // the next tree of a list
  TouchedTrees touched_;
};

}  // namespace talus
