#pragma once
#include <span>
#include <vector>

namespace talus {

/// P-values among simulated data sets.
struct Corrected {
  std::vector<double> effects;  ///< by effect: share of all sets, the measured one included, with one as small
  double all = 1.0;             ///< the p-value of the most unlikely effect
};

/// Corrects p-values for the number of places and effects. The measured data set is ranked among simulated ones: if the
/// model is right, each of them is equally likely to be the rarest. All effects count alike, whatever their number of
/// places.
///
/// @param simulated  by effect and data set: the smallest p-value over its places; or any number that is smaller the
///                   rarer, with which those of different effects can be compared
/// @param measured   by effect: the smallest p-value of the measured data over its places
Corrected corrected(std::span<const std::vector<double>> simulated, std::span<const double> measured);

}  // namespace talus
