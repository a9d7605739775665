#pragma once
#include <optional>
#include <string>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// Rock that falls from the sources in a year, by the frequencies of a scenario.
struct AnnualRock {
  double events = 0.0;     ///< of all sources [1/year]
  double volume = 0.0;     ///< of their blocks at the release [m^3/year]
  double from_area = 0.0;  ///< the part of `volume` that polygons release [m^3/year]
  double area = 0.0;       ///< of the surface of their cells, each counted once [m^2]

  /// How far the rock face in the polygons goes back in a year [m/year]; NaN without polygons: points and lines have no
  /// area.
  double retreat() const { return area > 0.0 ? from_area / area : kNotGiven; }
};

/// @return nothing if the valid scenario has no frequency
std::optional<AnnualRock> annual_rock(const Scenario& scenario);

/// "0.013 mm a year", "2.6 m a year".
std::string retreat_text(double metres_per_year);

/// A high rate of retreat [m/year]: 1.9 mm a year, measured in the Hohe Tauern, "ranks in the top range of reported
/// values" (Hartmeyer et al. 2020, Earth Surf. Dynam. 8, 753-768).
inline constexpr double kMuchRetreat = 2e-3;

/// How the warning below begins, in run.json, too.
inline constexpr const char* kRetreatWarning = "frequencies: ";

/// One line if the rock face would go back by more than 50 times what is much, as where events per hectare were typed
/// for events per m2: that of all polygons together, or of one that releases more than one block a year; empty if none
/// does.
std::string retreat_warning(const Scenario& scenario);

}  // namespace talus
