#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "talus/products/interval.hpp"

namespace talus {

/// The two-parameter Weibull distribution, P(X > x) = exp(-(x / scale)^shape).
struct Weibull {
  double shape = 1.0;  ///< k [-], > 0
  double scale = 1.0;  ///< lambda, in the unit of the values, > 0

  /// P(X > x); 1 below 0.
  double exceedance(double x) const;
};

/// The Weibull distribution of largest likelihood.
///
/// @param values  positive, at least two different ones
///
/// The shape is the one root of  sum x^k ln x / sum x^k - 1/k - mean ln x = 0  (it rises with k), to 40 bits; the scale
/// follows in closed form. Source: Johnson, Kotz & Balakrishnan, Continuous Univariate Distributions 1, ch. 21.
Weibull fit_weibull(std::span<const double> values);

/// Anderson-Darling distance of values from a Weibull distribution that was fitted to them, corrected for their number:
/// A^2 (1 + 0.2 / sqrt(n)).
///
/// @param sorted  ascending, positive
/// Source: D'Agostino & Stephens (1986), Goodness-of-Fit Techniques, Table 4.17, both parameters estimated.
double anderson_darling(std::span<const double> sorted, const Weibull& law);

/// What `anderson_darling` exceeds with 5 % chance where the values are of a Weibull distribution (same table).
inline constexpr double kAndersonDarling5 = 0.757;

/// Fewest values a Weibull distribution is fitted to.
inline constexpr std::size_t kFewestForWeibull = 10;

struct BootstrapOptions {
  std::uint32_t draws = 2000;
  std::uint64_t seed = 1;
  double confidence = 0.95;
};

/// A Weibull distribution fitted to values of which some may be 0, as the jump height of a block that slides: the
/// distribution is that of the others.
struct WeibullFit {
  Weibull law;
  std::size_t values = 0, zeros = 0;
  Interval shape{}, scale{};
  double distance = 0.0;       ///< anderson_darling
  std::vector<Weibull> draws;  ///< laws that the values may as well be of
  double confidence = 0.95;

  bool accepted() const { return distance <= kAndersonDarling5; }
};

/// Fits, and says how well the parameters are known.
///
/// @param values  none negative, at least kFewestForWeibull above 0, not all equal
///
/// Parametric bootstrap of the pivots: k^/k and (lambda^/lambda)^k have a distribution that does not depend on k and
/// lambda (Thoman, Bain & Antle 1969), so the intervals of shape, scale and every exceedance hold exactly, whatever n,
/// but for the number of draws. More than 2000 values: the deviations of 2000, shrunk with 1/sqrt(n).
/// Philox streams of (seed, draw): the same bits for the same n and seed.
WeibullFit fit_weibull(std::span<const double> values, const BootstrapOptions& options);

/// How often a limit is exceeded.
struct Exceedance {
  double fitted;             ///< by the law; the zeros count as not exceeding
  Interval fitted_bounds;    ///< by its draws
  double observed;           ///< share of the values above the limit
  Interval observed_bounds;  ///< Clopper-Pearson
};

/// @param values  those of the fit
Exceedance exceedance(const WeibullFit& fit, std::span<const double> values, double limit);

}  // namespace talus
