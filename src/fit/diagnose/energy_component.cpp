#include "talus/fit/diagnose/energy_component.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "pooled_products.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeast = 0.1;  // variance below which a crossing says nothing: it happens always or never

bool carries_energy(const Observable& o) {
  return o.kind != Observable::Kind::Lateral && o.kind != Observable::Kind::Mass;
}

/// Normal score of the middle rank of a crossing of share p: of those that cross (1 - p/2), of the others (1 - p)/2.
double crossing_score(double residual, double p) {
  return normal_quantile(residual > 0.0 ? 1.0 - 0.5 * p : 0.5 * (1.0 - p));
}

/// The mean products with those of pairs reduced; pairs that were never seen together are taken as independent.
MatrixXd reduced_covariance(const PooledProducts& pooled, double shrink) {
  MatrixXd c = pooled.means();
  for (Index i = 0; i < c.rows(); ++i)
    for (Index j = 0; j < c.cols(); ++j)
      if (i != j) c(i, j) *= 1.0 - shrink;
  return c;
}

}  // namespace

EnergyComponent::EnergyComponent(const ResidualSpace& space, const std::vector<BlockRuns>& runs) : space_(space) {
  for (std::size_t o = 0; o < space.observables().size(); ++o)
    if (carries_energy(space.observables()[o])) observables_.push_back(o);
  PooledProducts pooled(std::ssize(observables_));
  for (std::size_t b = 0; b < runs.size(); ++b)
    for (std::size_t t = 0; t < runs[b].trials; ++t) pooled.add(carriers(b, space.of_own_trial(b, runs[b], t)));
  covariance_ = reduced_covariance(pooled, space.rules().shrink);
}

VectorXd EnergyComponent::carriers(std::size_t block, const Residual& residual) const {
  VectorXd z(std::ssize(observables_));
  for (Index i = 0; i < z.size(); ++i) {
    const std::size_t o = observables_[static_cast<std::size_t>(i)];
    const double value = residual[static_cast<Index>(o)];
    const bool crossing = space_.observables()[o].kind == Observable::Kind::Crossed;
    z[i] = crossing ? crossing_score(value, space_.crossing_share(block, o)) : value;
  }
  return z;
}

const EnergyComponent::Weights& EnergyComponent::weights_of(const std::vector<bool>& seen) const {
  const auto known = weights_.find(seen);
  if (known != weights_.end()) return known->second;
  std::vector<Index> used;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] && covariance_(static_cast<Index>(i), static_cast<Index>(i)) > kLeast)
      used.push_back(static_cast<Index>(i));
  VectorXd weights = VectorXd::Zero(std::ssize(seen));
  while (!used.empty()) {
    const MatrixXd c = covariance_(used, used);
    const VectorXd w = c.ldlt().solve(c.diagonal());
    Index least = 0;
    if (w.minCoeff(&least) < 0.0 && used.size() > 1) {
      used.erase(used.begin() + least);
      continue;
    }
    weights(used) = w / std::sqrt(w.dot(c * w));
    break;
  }
  return weights_.emplace(seen, std::move(weights)).first->second;
}

double EnergyComponent::of(std::size_t block, const Residual& residual) const {
  VectorXd z = carriers(block, residual);
  std::vector<bool> seen;
  for (const double value : z) seen.push_back(!std::isnan(value));
  const Weights& weights = weights_of(seen);
  if (weights.isZero()) return kNotGiven;
  return weights.dot(z.array().isNaN().select(VectorXd::Zero(z.size()), z).matrix());
}

}  // namespace talus
