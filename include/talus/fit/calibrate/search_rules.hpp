#pragma once
#include "talus/physics/world.hpp"

namespace talus {

/// Numbers that rule the rounds of the quadratic model in a fit, of `calibrate` and of `diagnose` alike. z is the
/// distance of a parameter from its start, in standard deviations of its prior. Where no reason is given, the value is
/// a choice that has not been tuned. docs/diagnosis-method.md, "Rules", has them as a table.
struct SearchRules {
  /// Standard deviation of the design of the first round [z], where the caller gives none.
  double first_reach = 0.3;
  /// Least and largest standard deviation of later designs in any direction [z]: below, the noise hides every slope;
  /// above, the objective is no longer quadratic.
  double least_reach = 0.05, most_reach = 0.5;
  /// Rise of the objective over one standard deviation of a design [objective]: about the noise of one total.
  double rise = 0.005;
  /// Squared distance of a place from the centre, over what is typical of the design, up to which it counts [-].
  double local = 3.0;
  /// Standard deviations of the design within which a step stays [-]: the model knows nothing beyond.
  double trust = 2.0;
  /// Noise of a total before it is estimated [objective]: typical of what fits have shown.
  double first_noise = 0.007;
  /// Typical second derivatives of the objective along one direction and across two, per unit of the spread
  /// [objective]. With the noise they set the ridge, which holds back what few places cannot show.
  double curved = 0.03, twisted = 0.01;
  /// Vertices (impacts, pieces of slides and of flights with drag) after which a trajectory of a search ends at its
  /// limit [-]: it bounds very slow blocks, which take most steps. docs/diagnosis-time.md has what ordinary ones need.
  std::uint32_t most_vertices = 20000;
  /// Share of the speed that drag may take in one piece of a flight of a search [-]: five times that of a run, with an
  /// error of millimetres.
  double drag_loss = 0.2;
};

/// The bounds of a trajectory of a search.
inline Effort effort_of(const SearchRules& rules) {
  return {rules.most_vertices, rules.drag_loss};
}

}  // namespace talus
