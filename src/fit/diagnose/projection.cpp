#include "talus/fit/diagnose/projection.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numbers>

#include "talus/physics/effects/registry.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Sets of the days 0 to n - 1: all of them up to `few` days, of more days the runs of successive ones. The set of all
/// days is left out: it would be other ground.
std::vector<std::vector<std::size_t>> sets_of_days(std::size_t n, std::size_t few) {
  std::vector<std::vector<std::size_t>> sets;
  if (n <= few) {
    for (unsigned mask = 1; mask + 1 < 1U << n; ++mask) {
      sets.emplace_back();
      for (std::size_t day = 0; day < n; ++day)
        if (mask >> day & 1U) sets.back().push_back(day);
    }
    return sets;
  }
  for (std::size_t first = 0; first < n; ++first) {
    std::vector<std::size_t> run;
    for (std::size_t day = first; day < n && run.size() + 1 < n; ++day) {
      run.push_back(day);
      sets.push_back(run);
    }
  }
  return sets;
}

/// Groups of the n candidates of an effect that are tested together.
std::vector<std::vector<std::size_t>> groups_of(const std::string& effect, std::size_t n, const DiagnosisRules& rules) {
  const EffectEntry* entry = find_effect(effect);
  if (entry != nullptr && entry->sought == Sought::OnDays) return sets_of_days(n, rules.few_days);
  const std::size_t most = effect == "undeclared-zone" ? rules.most_joined : 1;
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t first = 0; first < n; ++first)
    for (std::size_t joined = 1; joined <= most && first + joined <= n; ++joined) {
      groups.emplace_back();
      for (std::size_t i = first; i < first + joined; ++i) groups.back().push_back(i);
    }
  return groups;
}

/// Shares of the data sets without an effect in which none, one, ... of the bounded estimates are inside their bounds.
/// Exact for one, for two of any correlation, and for more that are uncorrelated. Source: Shapiro (1988), section 5.
std::vector<double> inside_shares(int bounded, double correlation) {
  if (bounded == 2) {
    const double none = std::acos(std::clamp(correlation, -1.0, 1.0)) / (2.0 * std::numbers::pi);
    return {none, 0.5, 0.5 - none};
  }
  const boost::math::binomial inside(bounded, 0.5);
  std::vector<double> shares;
  for (int k = 0; k <= bounded; ++k) shares.push_back(boost::math::pdf(inside, k));
  return shares;
}

}  // namespace

double chi_bar_tail(double statistic, Index freedom, int bounded, double correlation) {
  if (!(statistic > 0.0)) return 1.0;
  const std::vector<double> shares = inside_shares(bounded, correlation);
  double tail = 0.0;
  for (int k = 0; k <= bounded; ++k) {
    const auto f = static_cast<double>(freedom - bounded + k);
    if (f > 0.0)
      tail += shares[static_cast<std::size_t>(k)] *
              boost::math::cdf(boost::math::complement(boost::math::chi_squared(f), statistic));
  }
  return tail;
}

namespace {

/// Indices of the parameters that the bits of `mask` leave free.
std::vector<Index> free_in(unsigned mask, Index size) {
  std::vector<Index> free;
  for (Index i = 0; i < size; ++i)
    if (mask >> i & 1U) free.push_back(i);
  return free;
}

}  // namespace

std::vector<TestedPlace> places_of(std::span<const Candidate> candidates, Index base, Index directions,
                                   const DiagnosisRules& rules) {
  std::vector<TestedPlace> places;
  Index next = base;
  for (std::size_t first = 0; first < candidates.size();) {
    std::size_t end = first;
    std::vector<Index> direction;
    for (; end < candidates.size() && candidates[end].effect == candidates[first].effect; ++end) {
      direction.push_back(next);
      next += static_cast<Index>(candidates[end].tested);
    }
    for (const std::vector<std::size_t>& group : groups_of(candidates[first].effect, end - first, rules)) {
      const Candidate& one = candidates[first + group.front()];
      TestedPlace place{{}, MatrixXd::Zero(directions, static_cast<Index>(one.tested)), {}};
      for (const std::size_t i : group) {
        place.members.push_back(first + i);
        for (Index p = 0; p < place.pick.cols(); ++p) place.pick(direction[i] + p, p) = 1.0;
      }
      for (std::size_t p = 0; p < one.tested; ++p) place.one_sided.push_back(one.parameters[p].one_sided());
      places.push_back(std::move(place));
    }
    first = end;
  }
  return places;
}

Projection::Projection(const TestedPlace& place, const MatrixXd& covariance, Index base, const VectorXd& steps,
                       double prior)
    : steps_(steps), one_sided_(place.one_sided) {
  MatrixXd information = covariance.topLeftCorner(base, base);
  information.diagonal().array() += prior;
  MatrixXd imitated = MatrixXd::Zero(place.pick.cols(), covariance.rows());
  imitated.leftCols(base) = information.ldlt().solve(covariance.topRows(base) * place.pick).transpose();
  map_ = place.pick.transpose() - imitated;
  information_ = map_ * covariance * map_.transpose();
  information_.diagonal().array() += 1e-9;
  std::vector<Index> bounded;
  for (std::size_t i = 0; i < one_sided_.size(); ++i)
    if (one_sided_[i]) bounded.push_back(static_cast<Index>(i));
  if (bounded.size() != 2) return;
  const MatrixXd covariance_of_estimates = information_.inverse();
  bounded_correlation_ =
      covariance_of_estimates(bounded[0], bounded[1]) /
      std::sqrt(covariance_of_estimates(bounded[0], bounded[0]) * covariance_of_estimates(bounded[1], bounded[1]));
}

Verdict Projection::verdict(const VectorXd& scores) const {
  const VectorXd s = map_ * scores;
  Verdict v;
  v.estimate = VectorXd::Zero(s.size());
  for (unsigned mask = 1; mask < 1U << s.size(); ++mask) {  // the bounded optimum is free in some, zero in the others
    const std::vector<Index> free = free_in(mask, s.size());
    const VectorXd part = s(free), estimate = information_(free, free).ldlt().solve(part);
    bool inside = true;
    for (std::size_t i = 0; i < free.size(); ++i)
      if (one_sided_[static_cast<std::size_t>(free[i])] && !(estimate[static_cast<Index>(i)] > 0.0)) inside = false;
    if (!inside || part.dot(estimate) <= v.statistic) continue;
    v.statistic = part.dot(estimate);
    v.estimate.setZero();
    v.estimate(free) = estimate;
  }
  v.ground = steps_.cwiseProduct(map_.leftCols(steps_.size()).transpose() * v.estimate);
  const auto bounded = static_cast<int>(std::count(one_sided_.begin(), one_sided_.end(), true));
  v.p_value = chi_bar_tail(v.statistic, s.size(), bounded, bounded_correlation_);
  return v;
}

}  // namespace talus
