#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "talus/base/sample.hpp"

namespace talus {

/// The two-parameter Weibull distribution, P(X > x) = exp(-(x / scale)^shape).
struct Weibull {
  double shape = 1.0;  ///< k [-], > 0
  double scale = 1.0;  ///< lambda, in the unit of the values, > 0

  /// P(X > x); 1 below 0.
  double exceedance(double x) const;
};

/// Fits a Weibull distribution by maximum likelihood.
///
/// @param values  positive, at least two different ones
///
/// The shape is the only root of  sum x^k ln x / sum x^k - 1/k - mean ln x = 0  (the left side rises with k), to 40
/// bits. The scale follows in closed form. Source: Johnson, Kotz & Balakrishnan, Continuous Univariate Distributions 1,
/// ch. 21.
Weibull fit_weibull(std::span<const double> values);

/// Anderson-Darling distance between values and the Weibull distribution fitted to them, corrected for their number:
/// A^2 (1 + 0.2 / sqrt(n)).
///
/// @param sorted  ascending, positive
/// Source: D'Agostino & Stephens (1986), Goodness-of-Fit Techniques, Table 4.17, both parameters estimated.
double anderson_darling(std::span<const double> sorted, const Weibull& law);

/// 5 % limit of `anderson_darling`: values of a Weibull distribution exceed it with this probability (same table).
inline constexpr double kAndersonDarling5 = 0.757;

/// Fewest values that a Weibull distribution is fitted to.
inline constexpr std::size_t kFewestForWeibull = 10;

struct BootstrapOptions {
  std::uint32_t draws = 2000;
  std::uint64_t seed = 1;
};

/// One of a bootstrap sample.
struct WeibullDraw {
  Weibull law;            ///< of the values above 0
  double positive = 1.0;  ///< their share
};

/// A Weibull distribution fitted to the values above 0. Some values may be 0, such as the jump height of a sliding
/// block.
struct WeibullFit {
  Weibull law;
  std::size_t values = 0, zeros = 0;
  Interval shape{}, scale{};
  double distance = 0.0;           ///< anderson_darling
  std::vector<WeibullDraw> draws;  ///< bootstrap sample

  bool accepted() const { return distance <= kAndersonDarling5; }
};

/// Fits a Weibull distribution, with intervals of its parameters.
///
/// @param values  none negative, at least kFewestForWeibull above 0, not all equal
///
/// Parametric bootstrap of the pivots: k^/k and (lambda^/lambda)^k have a distribution that does not depend on k and
/// lambda (Thoman, Bain & Antle 1969). So the intervals of shape, scale and every exceedance are exact for every n,
/// apart from the finite number of draws. For n > 2000 the deviations of 2000 values are multiplied by sqrt(2000 / n).
///
/// The share of the values above 0 is uncertain, too. Let m of n values be above 0: each draw takes its share from the
/// distribution Beta(m + 1/2, n - m + 1/2) (Jeffreys' prior; Brown, Cai & DasGupta 2001). The share is 1 if no value is
/// 0.
///
/// Philox streams of (seed, draw): the same bits for the same n, m and seed.
WeibullFit fit_weibull(std::span<const double> values, const BootstrapOptions& options);

/// Probability that a limit is exceeded.
struct Exceedance {
  double fitted;             ///< by the fitted law; values of 0 do not exceed
  Interval fitted_bounds;    ///< from the bootstrap draws
  double observed;           ///< share of the values above the limit
  Interval observed_bounds;  ///< Clopper-Pearson
};

/// @param values  the values that `fit` was fitted to
Exceedance exceedance(const WeibullFit& fit, std::span<const double> values, double limit);

}  // namespace talus
