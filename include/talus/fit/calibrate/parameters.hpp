#pragma once
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "talus/fit/campaign/observe.hpp"

namespace talus {

/// A number of a model that is fitted. The search moves in z, its distance from `centre` in units of `sd`:
///
///   log scale:    value = centre exp(sd z)          linear scale:  value = centre + sd z
///
/// The prior of z is standard normal.
struct Parameter {
  enum class Scale { Log, Linear };

  std::string key;                  ///< "ground.zones.talus.En50"
  std::string unit;                 ///< "m3/s2"; empty where there is none
  double lower = 0.0, upper = 0.0;  ///< bounds, in the units of the files; log scale: above 0
  Scale scale = Scale::Log;
  double centre = 1.0;  ///< of the prior, within the bounds
  double sd = 1.0;      ///< of the prior: of the logarithm, or in the unit of the value
  std::function<double(const Model&)> get;
  std::function<void(Model&, double)> set;
  double reach =
      std::numeric_limits<double>::infinity();  ///< a bound at this |z|, or beyond, is the search's, not the model's

  double value(double z) const;
  double z(double value) const;
  /// z, cut to the bounds.
  double within(double place) const;
  /// Whether z cannot be below zero: of most amounts of effects.
  bool one_sided() const { return lower >= centre; }
};

/// The parameters `keys` of ground_fields() in the given zones, with the start as centre of the prior. theta_scale,
/// psi_scale, En50 and Et50 on the log scale with sd 1 (a factor of e), phi on the linear one with sd 8 degrees; bounds
/// 2.5 sd from the start, and those of the field; on the log scale a start below `kLeastStart` counts as that. Throws
/// InputError for a key that cannot be fitted, and where there is no such zone.
std::vector<Parameter> ground_parameters(const Campaign& campaign, const Model& start,
                                         std::span<const std::string> keys, const std::vector<bool>& zones);

/// Smallest start on the log scale [unit of the value].
inline constexpr double kLeastStart = 0.01;

/// Throws InputError if a parameter on the log scale starts below `kLeastStart`: a search by factors would not leave 0,
/// and its interval would be one around another start.
void check_start(std::span<const Parameter> parameters, const Model& start);

/// The zones that enough simulated paths of the asked blocks touch: at least 5 % of them. Size: zones of the
/// campaign; an impact in a band of other ground counts for the zone under the band.
std::vector<bool> touched_zones(const Campaign& campaign, std::span<const BlockRuns> runs);

/// A model with the free parameters at z.
Model model_at(const Model& start, std::span<const Parameter> free, const Eigen::VectorXd& z);

}  // namespace talus
