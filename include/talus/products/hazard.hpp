#pragma once
#include <span>
#include <vector>

#include "talus/simulate/tally/hazard_tally.hpp"

namespace talus {

/// A value with its two-sided 95 % bounds.
struct Bounded {
  double value = 0.0, low = 0.0, high = 0.0;
};

/// Events in a return period that count as one: a frequency is a sum, whose rounding must not decide.
inline constexpr double kOnce = 1.0 - 1e-12;

/// Sums of the weights of the trajectories that were counted.
struct WeightSums {
  double sum = 0.0;      ///< [1/year]
  double squares = 0.0;  ///< sum of their squares [1/year^2]
  double overlap = 0.0;  ///< `HazardCell::overlaps`: the variance within the strata is squares - overlap [1/year^2]
};

/// The annual frequency of an event, from the trajectories that caused it, with 95 % bounds.
///
///   low = 0 at no trajectory, high = total at all of them; else, with w the largest weight, v = squares - overlap and
///   d(k) = upper Poisson bound of k, less k:
///   low  = max(gamma interval of Fay & Feuer (1997), sum - w d(v / w^2), total * Clopper-Pearson where equal)
///   high = min(the same, sum + w d(v / w^2), the same, total)
///
/// Covers at least 95 % for trajectories stratified by source cell: shown by simulation in the tests, not proven.
/// Source: Fay & Feuer, Statistics in Medicine 16 (1997), 791-801.
Bounded annual_frequency(const WeightSums& counted, const WeightScale& scale);

/// The 95 % gamma interval of Fay & Feuer for a weighted sum of Poisson counts, without the limits that
/// `annual_frequency` adds. `largest` is the largest weight that any count can have.
Bounded gamma_interval(double sum, double squares, double largest);

/// Years between events [year]: 1 / frequency, bounds exchanged; infinity where the frequency is 0.
Bounded return_period(const Bounded& frequency);

/// An energy at which hazard curves are given.
struct CurveEnergy {
  double energy;  ///< [kJ]
  int bin;        ///< the first bin above it
};

/// The energies of the hazard curves, ascending: 0 (all passages), 1, 2, 4, ... 131 072 kJ and the thresholds of the
/// run. All are edges of bins, so that no value is interpolated.
std::vector<CurveEnergy> curve_energies(const EnergyBins& bins);

/// Annual frequency of exceeding each energy, in one place.
class HazardCurve {
 public:
  /// @param rules  of the run; must outlive the curve
  HazardCurve(const HazardRules& rules, const HazardCell& cell);

  Bounded passage() const;                          ///< events per year
  Bounded exceedance(std::size_t threshold) const;  ///< of an energy threshold of the run [1/year]; exact
  /// Frequency of exceeding any energy [kJ]: exact at the edges of the bins, between them linear in the logarithm.
  Bounded exceedance_of(double energy) const;
  /// Frequency of the energies of a bin of the run and of all bins above it, without bounds [1/year]; exact.
  double frequency_from(int bin) const;

  /// The energy that is exceeded once in `years` years [kJ], read from the curve and from its lower and upper bounds.
  ///
  /// 0 if passages are rarer than that. The upper bound is infinite if even the bound for no trajectory is more
  /// frequent. Within a bin the curve is linear in the logarithm of the energy: the error is less than the bin, 12.5 %.
  Bounded energy_once_in(double years) const;

  int first() const { return first_; }               ///< bin of the lowest edge of the curve
  std::size_t size() const { return sums_.size(); }  ///< bins of the curve
  /// Frequency of exceeding edge first() + i; 0 at i = size().
  Bounded at(std::size_t i) const { return annual_frequency(sums_[i], rules_.scale); }

 private:
  enum class Side { Value, Low, High };
  double side(std::size_t i, Side which) const;
  double energy_of(double frequency, Side which) const;

  const HazardRules& rules_;
  int first_;
  std::vector<WeightSums> sums_;    // of each bin and all bins above it; the last is 0
  std::vector<WeightSums> levels_;  // of passage, then of each threshold
};

}  // namespace talus
