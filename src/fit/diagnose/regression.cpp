#include "talus/fit/diagnose/regression.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <set>

#include "talus/base/bounds.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kVaries = 1e-9;  // norm of a column, relative to the column with its means, below which it is constant
constexpr double kFollows = 1e-7;  // share of a column below which it follows from the others

/// Columns that vary within strata, of length 1; the others are zero.
MatrixXd normed_within(const MatrixXd& x, std::span<const std::size_t> strata) {
  MatrixXd columns = within_strata(x, strata);
  for (Index j = 0; j < columns.cols(); ++j) {
    const double norm = columns.col(j).norm();
    if (norm > kVaries * std::max(1.0, x.col(j).norm()))
      columns.col(j) /= norm;
    else
      columns.col(j).setZero();
  }
  return columns;
}

/// Orthonormal columns that span the same.
MatrixXd basis_of(const MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  qr.setThreshold(kFollows);
  if (qr.rank() == 0) return MatrixXd(columns.rows(), 0);
  return qr.householderQ() * MatrixXd::Identity(columns.rows(), qr.rank());
}

Index freedom_of(std::span<const std::size_t> strata, Index properties) {
  const std::set<std::size_t> different(strata.begin(), strata.end());
  return std::ssize(strata) - std::ssize(different) - properties;
}

}  // namespace

MatrixXd within_strata(const MatrixXd& columns, std::span<const std::size_t> strata) {
  std::map<std::size_t, std::vector<Index>> members;
  for (std::size_t i = 0; i < strata.size(); ++i) members[strata[i]].push_back(static_cast<Index>(i));
  MatrixXd out = columns;
  for (const auto& [stratum, rows] : members) {
    const Eigen::RowVectorXd mean = columns(rows, Eigen::all).colwise().mean();
    for (const Index row : rows) out.row(row) -= mean;
  }
  return out;
}

RegressionTest regression_test(const VectorXd& y, const MatrixXd& x, const Units& units, std::size_t arrangements,
                               std::uint64_t seed) {
  const MatrixXd columns = normed_within(x, units.strata), basis = basis_of(columns);
  VectorXd rest = within_strata(y, units.strata);
  const double norm = rest.norm();
  RegressionTest test;
  test.properties = basis.cols();
  test.freedom = freedom_of(units.strata, basis.cols());
  if (basis.cols() == 0 || !(norm > 0.0)) return test;
  rest /= norm;
  const bool saturated = test.freedom < 1;
  const MatrixXd& directions = saturated ? columns : basis;
  VectorXd moved(rest.size());
  const auto explained = [&](std::span<const std::size_t> givers) {
    for (Index i = 0; i < rest.size(); ++i) moved[i] = rest[static_cast<Index>(givers[static_cast<std::size_t>(i)])];
    const VectorXd along = directions.transpose() * moved;
    return saturated ? along.cwiseAbs2().maxCoeff() : along.squaredNorm();
  };
  const Arrangements ways(units, arrangements, seed);
  test.permuted = ways.test(explained);
  test.explained = std::min(1.0, explained(ways.givers(0)));
  test.f = test.p_of_f = kNotGiven;
  if (saturated) return test;
  const auto properties = static_cast<double>(test.properties), freedom = static_cast<double>(test.freedom);
  test.f = test.explained / properties / ((1.0 - test.explained) / freedom);
  test.p_of_f = test.explained < 1.0
                    ? boost::math::cdf(boost::math::complement(boost::math::fisher_f(properties, freedom), test.f))
                    : 0.0;
  return test;
}

std::vector<PartialCorrelation> slopes(const VectorXd& y, const MatrixXd& x, std::span<const std::size_t> strata) {
  const MatrixXd columns = normed_within(x, strata);
  const VectorXd rest = within_strata(y, strata);
  const Index freedom = freedom_of(strata, basis_of(columns).cols());
  std::vector<PartialCorrelation> list;
  for (Index j = 0; j < columns.cols(); ++j) {
    MatrixXd others = columns;
    others.col(j).setZero();
    const MatrixXd known = basis_of(others);
    const VectorXd own = columns.col(j) - known * (known.transpose() * columns.col(j));
    const VectorXd left = rest - known * (known.transpose() * rest);
    if (own.norm() < kFollows || !(left.norm() > 0.0)) {
      list.push_back({kNotGiven, kNotGiven});
      continue;
    }
    const double r = std::clamp(own.dot(left) / (own.norm() * left.norm()), -1.0, 1.0);
    PartialCorrelation slope{r, kNotGiven};
    if (freedom >= 1) {
      const auto f = static_cast<double>(freedom);
      const double t = std::abs(r) * std::sqrt(f / std::max(1e-300, 1.0 - r * r));
      slope.p_value = 2.0 * boost::math::cdf(boost::math::complement(boost::math::students_t(f), t));
    }
    list.push_back(slope);
  }
  return list;
}

}  // namespace talus
