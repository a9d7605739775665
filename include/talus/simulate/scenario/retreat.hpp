#pragma once
#include <optional>
#include <string>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// What falls from the sources in a year, by the frequencies of a scenario.
struct AnnualRock {
  double events = 0.0;  ///< [1/year]
  double volume = 0.0;  ///< of the blocks at their release [m^3/year]
  double area = 0.0;    ///< of the surface of the source cells [m^2]; 0 if a source is a point

  /// How far the rock face goes back in a year [m/year]; NaN without an area.
  double retreat() const { return area > 0.0 ? volume / area : kNotGiven; }
};

/// @return nothing if the valid scenario has no frequency
std::optional<AnnualRock> annual_rock(const Scenario& scenario);

/// How the warning below begins, in run.json, too.
inline constexpr const char* kRetreatWarning = "frequencies: ";

/// One line if the rock face would go back by more than 0.1 m a year, as where events per hectare were typed for events
/// per m2; empty if not. Measured in the Alps: 2 mm a year is much (Hartmeyer et al. 2020, Earth Surf. Dynam. 8, 753).
std::string retreat_warning(const Scenario& scenario);

}  // namespace talus
