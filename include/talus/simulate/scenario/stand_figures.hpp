#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// Smallest, largest and mean of some numbers.
struct Spread {
  double low = std::numeric_limits<double>::infinity(), high = 0.0, sum = 0.0;
  std::uint64_t count = 0;

  void add(double value);
  double mean() const { return sum / static_cast<double>(count); }
  std::string text() const;  ///< "250 to 450 (mean 386)"; "450" if all are equal
};

/// The median of many positive numbers, to about 1 %: their counts in bins of 1/200 of a decade, from 1e-4 to 1e6.
class Median {
 public:
  void add(double value);
  /// 0 if there are no numbers.
  double value() const;

 private:
  static constexpr double kFirst = -4.0, kPerDecade = 200.0;
  static constexpr int kBins = 2000;
  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t all_ = 0;
};

/// Cross-section of a stem at breast height [m2]. @param diameter  DBH [m]
double stem_section(double diameter);

/// The stand of forest-stems over the cells in which it acts; not of a list of trees.
struct StandFigures {
  Spread density, diameter;  ///< [1/ha], [m]
  Median densities;          ///< [1/ha]
  Median basal_areas;        ///< cross-sections of the stems at breast height [m2/ha]
};
StandFigures stand_figures(const Scenario& scenario);

}  // namespace talus
