#pragma once
#include <span>
#include <string>
#include <vector>

namespace talus {

/// Classes of hazard by how strong events are and how often they come.
///
/// The default is the usual form of the Swiss one for falls: 30 and 300 kJ; 30, 100 and 300 years. Authorities have
/// their own. docs/hazard.md, "Classes".
struct HazardMatrix {
  std::vector<double> energies{30.0, 300.0};      ///< between weak, medium, strong [kJ], ascending
  std::vector<double> years{30.0, 100.0, 300.0};  ///< upper ends of the return periods, ascending
  /// By intensity, weak first, then by return period, often first; the last column is for what is rarer.
  std::vector<std::vector<int>> classes{{3, 2, 2, 1}, {4, 3, 3, 1}, {4, 4, 4, 1}};
  std::vector<std::string> names{"none", "residual", "low", "medium", "high"};  ///< of class 0, 1, ...
};

/// What is wrong with a matrix, in words; empty where nothing is.
std::string fault_of(const HazardMatrix& matrix);

/// The highest class that any intensity reaches; 0 where nothing happens.
///
/// @param frequencies  how often the lower end of each intensity is exceeded [1/year]: passage, then each of `energies`
/// @param rare         whether what is rarer than the last of `years` counts
int class_of(const HazardMatrix& matrix, std::span<const double> frequencies, bool rare = true);

}  // namespace talus
