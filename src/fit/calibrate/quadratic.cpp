#include "talus/fit/calibrate/quadratic.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "talus/base/expect.hpp"

namespace talus {

QuadraticFit::QuadraticFit(const Eigen::MatrixXd& places, const Eigen::VectorXd& weights, const Ridge& ridge)
    : directions_(places.rows()) {
  TALUS_EXPECT(weights.size() == places.cols() && places.allFinite(), "each place has a weight");
  const Eigen::Index n = directions_, coefficients = 1 + n + n * (n + 1) / 2;
  features_.resize(places.cols(), coefficients);
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const Eigen::VectorXd u = places.col(i);
    features_(i, 0) = 1.0;
    features_.row(i).segment(1, n) = u;
    Eigen::Index column = 1 + n;
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = a; b < n; ++b) features_(i, column++) = (a == b ? 0.5 : 1.0) * u[a] * u[b];
  }
  const Eigen::MatrixXd weighted = weights.asDiagonal() * features_;
  Eigen::MatrixXd normal = features_.transpose() * weighted;
  normal.diagonal().head(1 + n).array() += 1e-9;
  Eigen::Index k = 1 + n;
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = a; b < n; ++b, ++k) normal(k, k) += a == b ? ridge.pure : ridge.mixed;
  solver_ = normal.ldlt().solve(weighted.transpose());
}

Eigen::MatrixXd QuadraticFit::coefficients(const Eigen::MatrixXd& values) const {
  return solver_ * values;
}

Eigen::MatrixXd QuadraticFit::curvature(const Eigen::VectorXd& coefficients) const {
  Eigen::MatrixXd h(directions_, directions_);
  Eigen::Index k = 1 + directions_;
  for (Eigen::Index a = 0; a < directions_; ++a)
    for (Eigen::Index b = a; b < directions_; ++b) h(a, b) = h(b, a) = coefficients[k++];
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(h);
  return parts.eigenvectors() * parts.eigenvalues().cwiseMax(0.0).asDiagonal() * parts.eigenvectors().transpose();
}

Eigen::VectorXd minimum_in_box(const Eigen::VectorXd& g, const Eigen::MatrixXd& h, const Eigen::VectorXd& low,
                               const Eigen::VectorXd& high) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(g.size()).cwiseMax(low).cwiseMin(high);
  for (int sweep = 0; sweep < 200; ++sweep) {
    double moved = 0.0;
    for (Eigen::Index i = 0; i < g.size(); ++i) {
      const double slope = g[i] + h.row(i).dot(u) - h(i, i) * u[i];
      const double next = std::clamp(-slope / h(i, i), low[i], high[i]);
      moved = std::max(moved, std::abs(next - u[i]));
      u[i] = next;
    }
    if (!(moved > 1e-6)) break;
  }
  return u;
}

}  // namespace talus
