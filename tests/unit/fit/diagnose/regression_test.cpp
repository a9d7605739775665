#include "talus/fit/diagnose/regression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scenes.hpp"

namespace talus::test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Units units_in(const std::vector<std::size_t>& strata) {
  Units units{{}, strata};
  for (std::size_t i = 0; i < strata.size(); ++i) units.streams.push_back(static_cast<std::uint32_t>(31 * i + 5));
  return units;
}

MatrixXd normals(Numbers& numbers, Index rows, Index columns) {
  return MatrixXd::NullaryExpr(rows, columns, [&](Index, Index) { return numbers.normal(); });
}

/// x = 1..5, y = 2 1 4 3 5: r = 0.8, F = 0.64 / (0.36 / 3); p of t with three of freedom in closed form.
TEST(Regression, FOfFivePointsByHand) {
  const VectorXd x = VectorXd::LinSpaced(5, 1.0, 5.0), y = (VectorXd(5) << 2.0, 1.0, 4.0, 3.0, 5.0).finished();
  const RegressionTest test = regression_test(y, x, units_in({0, 0, 0, 0, 0}), 1000, 1);
  const double a = 4.0 / 3.0, p = 1.0 - 2.0 / std::numbers::pi * (std::atan(a) + a / (1.0 + a * a));
  EXPECT_NEAR(test.explained, 0.64, 1e-12);
  EXPECT_NEAR(test.f, 16.0 / 3.0, 1e-12);
  EXPECT_NEAR(test.p_of_f, p, 1e-12);
  EXPECT_EQ(test.freedom, 3);
  // |sum of x y| as far from 45: 4 of distance 2 below the most, and 1 at the most, on each side: 0.8 has sum 53.
  // Of the 120 arrangements 1 has sum 55, 4 have 54, 3 have 53, and as many are as far below: 16.
  EXPECT_TRUE(test.permuted.exact);
  EXPECT_DOUBLE_EQ(test.permuted.p_value, 16.0 / 120.0);
  const std::vector<PartialCorrelation> all = slopes(y, x, units_in({0, 0, 0, 0, 0}).strata);
  EXPECT_NEAR(all[0].correlation, 0.8, 1e-12);
  EXPECT_NEAR(all[0].p_value, p, 1e-12);
}

/// Of normal numbers the permutation test gives the F test's p-value, up to the noise of 2000 permutations.
TEST(Regression, OfNormalNumbersThePermutationsAgreeWithF) {
  Numbers numbers(3);
  std::vector<std::size_t> strata;
  for (std::size_t i = 0; i < 60; ++i) strata.push_back(i % 2);
  for (int set = 0; set < 20; ++set) {
    const RegressionTest test =
        regression_test(normals(numbers, 60, 1), normals(numbers, 60, 3), units_in(strata), 2000, 1);
    EXPECT_EQ(test.freedom, 55);
    const double p = test.p_of_f;
    EXPECT_NEAR(test.permuted.p_value, p, 5.0 * std::sqrt(p * (1.0 - p) / 2000.0) + 1.0 / 2000.0);
  }
}

TEST(Regression, AScaleAndASiteDoNotMatterAndCopiesAreDropped) {
  Numbers numbers(4);
  std::vector<std::size_t> strata;
  for (std::size_t i = 0; i < 40; ++i) strata.push_back(i < 13 ? 7 : 2);
  const VectorXd y = normals(numbers, 40, 1);
  MatrixXd x = normals(numbers, 40, 4);
  x.col(2).setConstant(3.5);
  x.col(3) = 2.0 * x.col(0) - x.col(1);
  VectorXd other = 2.6 * y;
  other.head(13).array() += 40.0;
  const RegressionTest one = regression_test(y, x.leftCols(2), units_in(strata), 500, 1);
  const RegressionTest two = regression_test(other, x, units_in(strata), 500, 1);
  EXPECT_EQ(two.properties, 2);
  EXPECT_NEAR(two.explained, one.explained, 1e-9);
  EXPECT_EQ(two.permuted.p_value, one.permuted.p_value);
  EXPECT_TRUE(std::isnan(slopes(other, x, strata)[2].correlation));
}

/// Three means and two properties leave no freedom: the largest correlation counts, and no p is below one in six.
TEST(Regression, ThreeUnitsSayLittle) {
  MatrixXd x(3, 2);
  x << 0.0, 1.0, 1.0, 5.0, 2.0, 2.0;
  const RegressionTest test = regression_test(VectorXd::LinSpaced(3, 0.0, 10.0), x, units_in({0, 0, 0}), 1000, 1);
  EXPECT_EQ(test.freedom, 0);
  EXPECT_NEAR(test.explained, 1.0, 1e-12);
  EXPECT_TRUE(std::isnan(test.f));
  EXPECT_EQ(test.permuted.arrangements, 6U);
  EXPECT_DOUBLE_EQ(test.permuted.p_value, 2.0 / 6.0);  // it and its mirror image
}

}  // namespace
}  // namespace talus::test
