#pragma once
#include <Eigen/Core>

#include "talus/fit/diagnose/permutation.hpp"

namespace talus {

/// Columns less their mean over each stratum: what is left when each stratum has an intercept of its own.
Eigen::MatrixXd within_strata(const Eigen::MatrixXd& columns, std::span<const std::size_t> strata);

/// A test whether a quantity depends on any of some properties, with an intercept for each stratum.
struct RegressionTest {
  Eigen::Index properties = 0;  ///< columns that count: those that vary and do not follow from the others
  Eigen::Index freedom = 0;     ///< of the rest: units less strata less properties
  double explained = 0.0;       ///< share of the variance within strata, 0..1
  double f = 0.0;               ///< F statistic of all properties together; NaN where no freedom is left
  double p_of_f = 1.0;          ///< of a rest that is normal
  PermutationTest permuted;     ///< needs no distribution: the p-value that counts
};

/// Regresses `y` on the columns of `x` and permutes what the strata leave of y among the units of a stratum (Freedman
/// and Lane 1983; with intercepts alone beside the properties this is exact). A scale of y that is wrong does not
/// matter.
///
/// Where the properties leave no freedom (three rocks have three means), the statistic is the largest squared
/// correlation with one of them.
///
/// @param x  units x properties, finite
RegressionTest regression_test(const Eigen::VectorXd& y, const Eigen::MatrixXd& x, const Units& units,
                               std::size_t arrangements, std::uint64_t seed);

/// A property in the regression on all of them.
struct PartialCorrelation {
  double correlation = 0.0;  ///< with y, both without strata and without the other properties, -1..1
  double p_value = 1.0;      ///< of t, two-sided; NaN where no freedom is left
};
/// By column of `x`; correlation NaN for columns that do not count.
std::vector<PartialCorrelation> slopes(const Eigen::VectorXd& y, const Eigen::MatrixXd& x,
                                       std::span<const std::size_t> strata);

}  // namespace talus
