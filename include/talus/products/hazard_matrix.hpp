#pragma once
#include <span>
#include <string>
#include <vector>

#include "talus/products/hazard.hpp"

namespace talus {

/// Classes of hazard by intensity and return period of the events.
///
/// The default has the form that is usual in Switzerland for falls: 30 and 300 kJ; 30, 100 and 300 years. Authorities
/// have their own matrices. docs/hazard.md, "Classes".
struct HazardMatrix {
  std::vector<double> energies{30.0, 300.0};      ///< between weak, medium, strong [kJ], ascending
  std::vector<double> years{30.0, 100.0, 300.0};  ///< upper ends of the return periods, ascending
  /// A row per intensity, weak first; a column per return period, frequent first; the last column is for rarer events.
  std::vector<std::vector<int>> classes{{3, 2, 2, 1}, {4, 3, 3, 1}, {4, 4, 4, 1}};
  std::vector<std::string> names{"none", "residual", "low", "medium", "high"};  ///< of class 0, 1, ...
};

/// The first fault of a matrix, as a sentence; empty if the matrix is valid.
std::string fault_of(const HazardMatrix& matrix);

/// The highest class over all intensities; 0 if nothing happens.
///
/// @param frequencies  how often the lower end of each intensity is exceeded [1/year]: passage, then each of `energies`
/// @param rare         whether events rarer than the last of `years` count
int class_of(const HazardMatrix& matrix, std::span<const double> frequencies, bool rare = true);

/// The class by frequencies with bounds.
struct BoundedClass {
  int value = 0, low = 0, high = 0;  ///< by the frequencies, by their lower and by their upper bounds
  bool undecided = false;            ///< more trajectories may give another class
};
/// Events rarer than the last of `years` do not count at the upper bounds: else no place would be free of them.
///
/// @param frequencies  as above
BoundedClass class_of(const HazardMatrix& matrix, std::span<const Bounded> frequencies);

}  // namespace talus
