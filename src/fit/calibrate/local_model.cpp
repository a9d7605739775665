#include "local_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "normal_draws.hpp"
#include "talus/base/elementary.hpp"
#include "talus/fit/score/bootstrap.hpp"

namespace talus {
namespace {

/// Eigen cuts large products by the sizes of the processor's caches, which changes the order of their sums. These are
/// the sizes of a common processor (first, second, third level), for every machine.
[[maybe_unused]] const bool kSameSumsEverywhere = [] {
  Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 4 << 20);
  return true;
}();

/// Weight of each row in the total, for weights of the blocks: the weighted mean over the groups of weighted means.
Eigen::VectorXd row_weights(const Score& score, std::span<const double> block) {
  std::vector<double> total(score.groups.size(), 0.0);
  for (const RowScore& row : score.rows) total[row.group] += block[row.block];
  double groups = 0.0;
  for (std::size_t g = 0; g < total.size(); ++g)
    if (total[g] > 0.0) groups += score.groups[g].weight;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(std::ssize(score.rows));
  for (std::size_t r = 0; r < score.rows.size(); ++r) {
    const RowScore& row = score.rows[r];
    if (total[row.group] > 0.0)
      weights[static_cast<Eigen::Index>(r)] =
          score.groups[row.group].weight * block[row.block] / total[row.group] / groups;
  }
  return weights;
}

}  // namespace

LocalModel::LocalModel(const FitProblem& problem, const FitOptions& options, const EndOfFit& fit,
                       const Eigen::MatrixXd& spread)
    : problem_(problem), options_(options), score_(fit.score), prior_(problem.prior(options)), centre_(fit.z) {
  const Eigen::Index n = std::ssize(problem.free), count = std::ssize(fit.evaluations);
  low_.resize(n);
  high_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    low_[i] = problem.free[i].z(problem.free[i].lower) - centre_[i];
    high_[i] = problem.free[i].z(problem.free[i].upper) - centre_[i];
  }
  const Eigen::MatrixXd root =
      spread.llt().matrixL();  // u = root v: the model is fitted in v, where the design is round
  const Eigen::MatrixXd inverse = root.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(n, n));
  Eigen::MatrixXd places(n, count), values(count, std::ssize(score_.rows));
  Eigen::VectorXd weights(count);
  noise_factor_.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Evaluation& e = fit.evaluations[static_cast<std::size_t>(i)];
    places.col(i) = inverse * (e.z - centre_);
    values.row(i) = e.rows;
    const double away = places.col(i).squaredNorm() / static_cast<double>(n);  // 1 is typical of the design
    const double precision = static_cast<double>(e.trials) / options.trials;
    weights[i] = away <= options.rules.local ? precision * exponential(-0.5 * away) : 0.0;
    noise_factor_[i] = 1.0 / std::sqrt(precision);
  }
  const Eigen::VectorXd ones = row_weights(score_, std::vector<double>(problem.rows().size(), 1.0));
  const Eigen::VectorXd totals = values * ones;
  const auto used = static_cast<double>((weights.array() > 0.0).count());
  const double of_full_trials = weights.dot(noise_factor_.cwiseAbs2());  // noise_ is that of FitOptions::trials
  noise_ = options.rules.first_noise;
  for (int pass = 0; pass < 3; ++pass) {  // the ridge depends on the noise, and the noise, weakly, on the ridge
    const double pure = noise_ / options.rules.curved, mixed = noise_ / options.rules.twisted;
    model_.emplace(places, weights, QuadraticFit::Ridge{pure * pure, mixed * mixed});
    total_ = model_->coefficients(totals);
    const Eigen::VectorXd rest = totals - model_->at_places(total_);
    const double free = std::max(0.1, 1.0 - model_->coefficients_used() / used);
    noise_ = std::sqrt(rest.cwiseAbs2().dot(weights) / (of_full_trials * free));
  }
  rows_ = model_->coefficients(values);
  from_v_ = inverse.transpose();
  curvature_ = curvature_of(total_, prior_);
}

Eigen::MatrixXd LocalModel::curvature_of(const Eigen::VectorXd& total, double prior) const {
  Eigen::MatrixXd curvature = from_v_ * model_->curvature(total) * from_v_.transpose();
  curvature.diagonal().array() += 2.0 * prior;
  return curvature;
}

Eigen::MatrixXd LocalModel::first_spread(Eigen::Index parameters, const SearchRules& rules) {
  return rules.first_reach * rules.first_reach * Eigen::MatrixXd::Identity(parameters, parameters);
}

std::vector<Eigen::VectorXd> LocalModel::design(const FitProblem& problem, std::uint64_t seed,
                                                const Eigen::VectorXd& centre, const Eigen::MatrixXd& spread, int count,
                                                std::uint32_t first) {
  const Eigen::MatrixXd root = spread.llt().matrixL();
  std::vector<Eigen::VectorXd> places;
  for (int k = 0; k < count; ++k) {
    Eigen::VectorXd z =
        centre + root * normal_draws(seed, NormalDraw::Place, first + static_cast<std::uint32_t>(k), centre.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = problem.free[static_cast<std::size_t>(i)].within(z[i]);
    places.push_back(std::move(z));
  }
  return places;
}

std::uint32_t LocalModel::first_unused(std::span<const Evaluation> known, std::uint32_t trials) {
  std::uint32_t used = 0;
  for (const Evaluation& e : known) used += e.trials;
  return (used + trials - 1) / trials;
}

Eigen::VectorXd LocalModel::step(const Eigen::MatrixXd& spread) const {
  return optimum(std::vector<double>(problem_.rows().size(), 1.0), spread);
}

Eigen::VectorXd LocalModel::optimum(std::span<const double> block_weights, const Eigen::MatrixXd& spread) const {
  const Eigen::VectorXd trust = options_.rules.trust * spread.diagonal().cwiseSqrt();
  const Eigen::VectorXd total = rows_ * row_weights(score_, block_weights);
  const std::vector<bool> used = problem_.rows();
  double blocks = 0.0, counted = 0.0;
  for (std::size_t b = 0; b < block_weights.size(); ++b)
    if (used[b]) blocks += 1.0, counted += block_weights[b];
  const double prior = prior_ * blocks / counted;  // for the number of blocks that count
  const Eigen::VectorXd slope = from_v_ * model_->gradient(total) + 2.0 * prior * centre_;
  return centre_ + minimum_in_box(slope, curvature_of(total, prior), low_.cwiseMax(-trust), high_.cwiseMin(trust));
}

Eigen::VectorXd LocalModel::draw(std::uint32_t draw) const {
  const Eigen::VectorXd weights = row_weights(score_, bootstrap_weights(problem_.streams(), draw, options_.seed));
  const Eigen::VectorXd noise =
      noise_ * normal_draws(options_.seed, NormalDraw::Noise, draw, noise_factor_.size()).cwiseProduct(noise_factor_);
  const Eigen::VectorXd slope = from_v_ * model_->gradient(rows_ * weights - total_ + model_->coefficients(noise)) -
                                2.0 * prior_ * normal_draws(options_.seed, NormalDraw::Prior, draw, low_.size());
  return centre_ + minimum_in_box(slope, curvature_, low_, high_);
}

Eigen::MatrixXd LocalModel::next_spread() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(curvature_);
  const Eigen::VectorXd reach = (2.0 * options_.rules.rise * axes.eigenvalues().cwiseInverse()).cwiseSqrt();
  const SearchRules& rules = options_.rules;
  const Eigen::VectorXd variance = reach.cwiseMax(rules.least_reach).cwiseMin(rules.most_reach).cwiseAbs2();
  return axes.eigenvectors() * variance.asDiagonal() * axes.eigenvectors().transpose();
}

}  // namespace talus
