#include "talus/fit/uncertainty.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "talus/base/random.hpp"
#include "talus/fit/quadratic.hpp"

namespace talus {
namespace {

constexpr double kFirstReach = 0.3;            // standard deviation of the first design around the fit, in z
constexpr double kNarrow = 0.15, kWide = 0.5;  // of the later ones, in any direction
constexpr double kTrust = 2.0;                 // a step to a better centre stays within so many of them
constexpr double kLargestCurve = 0.1;          // typical second derivative of the total, for the ridge
constexpr double kTypicalNoise = 0.005;        // of a total, for the ridge

/// Weight of each row in the total, for weights of the blocks: the mean over the groups of weighted means.
Eigen::VectorXd row_weights(const Score& score, std::span<const double> block) {
  std::vector<double> total(score.groups.size(), 0.0);
  for (const RowScore& row : score.rows) total[row.group] += block[row.block];
  const auto groups = static_cast<double>(std::count_if(total.begin(), total.end(), [](double t) { return t > 0.0; }));
  Eigen::VectorXd weights(std::ssize(score.rows));
  for (std::size_t r = 0; r < score.rows.size(); ++r) {
    const RowScore& row = score.rows[r];
    weights[static_cast<Eigen::Index>(r)] = total[row.group] > 0.0 ? block[row.block] / total[row.group] / groups : 0.0;
  }
  return weights;
}

/// Standard normal numbers of one draw.
Eigen::VectorXd normals(std::uint64_t seed, std::uint32_t stream, std::uint32_t draw, Eigen::Index count) {
  const Random random(seed, stream, draw, Purpose::Bootstrap);
  Eigen::VectorXd z(count);
  for (Eigen::Index i = 0; i < count; i += 4) {
    const Words w = random.words(static_cast<std::uint32_t>(i / 4));
    const auto a = normal_pair(w[0], w[1]), b = normal_pair(w[2], w[3]);
    const double four[] = {a[0], a[1], b[0], b[1]};
    for (Eigen::Index k = i; k < std::min(count, i + 4); ++k) z[k] = four[k - i];
  }
  return z;
}

/// A quadratic model of every row score around a centre, and the draws that it gives.
class Sampler {
 public:
  /// @param spread  covariance of where the model must hold: places far from the centre count less
  Sampler(const Campaign& campaign, std::span<const Parameter> free, const FitOptions& options, double prior,
          const Fit& fit, const Eigen::VectorXd& centre, const Eigen::MatrixXd& spread)
      : campaign_(campaign), options_(options), prior_(prior), fit_(fit), centre_(centre) {
    const Eigen::Index n = std::ssize(free);
    low_.resize(n);
    high_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      low_[i] = free[i].z(free[i].lower) - centre[i];
      high_[i] = free[i].z(free[i].upper) - centre[i];
    }
    learn(spread);
  }

  /// Draw number `draw` of the posterior sample.
  Eigen::VectorXd draw(std::uint32_t draw) const {
    const Eigen::VectorXd weights =
        row_weights(fit_.score, bootstrap_weights(fit_.score, campaign_.blocks.size(), draw, options_.seed));
    const Eigen::VectorXd luck = noise_ * normals(options_.seed, 1, draw, luck_scale_.size()).cwiseProduct(luck_scale_);
    const Eigen::VectorXd gradient = model_->gradient(rows_ * weights + model_->coefficients(luck));
    return minimum(gradient, normals(options_.seed, 2, draw, low_.size()));
  }

  /// The minimum for the blocks as they are, no further from the centre than `trust` in each direction.
  Eigen::VectorXd best(const Eigen::VectorXd& trust) const {
    const Eigen::VectorXd slope = model_->gradient(total_) + 2.0 * prior_ * centre_;
    return centre_ + minimum_in_box(slope, curvature_, low_.cwiseMax(-trust), high_.cwiseMin(trust));
  }

  double noise() const { return noise_; }

 private:
  void learn(const Eigen::MatrixXd& spread) {
    const auto& all = fit_.evaluations;
    const Eigen::Index count = std::ssize(all), n = low_.size();
    Eigen::MatrixXd places(n, count), values(count, all[0].rows.size());
    Eigen::VectorXd weights(count);
    luck_scale_.resize(count);
    const Eigen::LLT<Eigen::MatrixXd> factors(spread);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Evaluation& e = all[static_cast<std::size_t>(i)];
      places.col(i) = e.z;
      values.row(i) = e.rows;
      const Eigen::VectorXd u = e.z - centre_;
      const double precision = static_cast<double>(e.trials) / options_.trials;
      weights[i] = precision * std::exp(-u.dot(factors.solve(u)) / (2.0 * static_cast<double>(n)));
      luck_scale_[i] = 1.0 / std::sqrt(precision);
    }
    const double ridge = (kTypicalNoise / kLargestCurve) * (kTypicalNoise / kLargestCurve);
    model_.emplace(places, weights, centre_, ridge);
    rows_ = model_->coefficients(values);
    const Eigen::VectorXd ones = row_weights(fit_.score, std::vector<double>(campaign_.blocks.size(), 1.0));
    total_ = rows_ * ones;
    curvature_ = model_->curvature(total_);
    curvature_.diagonal().array() += 2.0 * prior_;
    const Eigen::VectorXd rest = values * ones - model_->at_places(total_);
    noise_ = std::sqrt(rest.cwiseAbs2().dot(weights) / weights.sum());
  }

  /// Of the quadratic plus the prior around `prior_centre`.
  Eigen::VectorXd minimum(const Eigen::VectorXd& gradient, const Eigen::VectorXd& prior_centre) const {
    return centre_ + minimum_in_box(gradient + 2.0 * prior_ * (centre_ - prior_centre), curvature_, low_, high_);
  }

  const Campaign& campaign_;
  const FitOptions& options_;
  double prior_;
  const Fit& fit_;
  Eigen::VectorXd centre_, low_, high_;  // low, high: from the centre
  std::optional<QuadraticFit> model_;
  Eigen::MatrixXd rows_;  // coefficients x row scores
  Eigen::VectorXd total_, luck_scale_;
  Eigen::MatrixXd curvature_;
  double noise_ = 0.0;
};

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& draws) {
  const Eigen::MatrixXd centred = draws.rowwise() - draws.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(draws.rows() - 1);
}

/// The covariance with the standard deviation along each of its principal axes brought into a range.
Eigen::MatrixXd within(const Eigen::MatrixXd& covariance, double narrow, double wide) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
  const Eigen::VectorXd variance = axes.eigenvalues().cwiseMax(narrow * narrow).cwiseMin(wide * wide);
  return axes.eigenvectors() * variance.asDiagonal() * axes.eigenvectors().transpose();
}

void summarise(std::span<const Parameter> free, Uncertainty& out) {
  const Eigen::Index n = out.draws.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double> z(out.draws.col(i).begin(), out.draws.col(i).end());
    std::sort(z.begin(), z.end());
    const double low = quantile(z, 0.025), high = quantile(z, 0.975);
    const Parameter& p = free[static_cast<std::size_t>(i)];
    out.intervals.push_back({p.value(low), p.value(high)});
    const double possible = std::min(2.0 * 1.96, p.z(p.upper) - p.z(p.lower));
    out.identifiable.push_back(high - low <= kMostOfThePrior * possible);
  }
  const Eigen::MatrixXd covariance = covariance_of(out.draws);
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  out.correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace

Uncertainty uncertainty_of(const Campaign& campaign, const Model& start, std::span<const Parameter> free,
                           const std::vector<bool>& rows, const FitOptions& options, const UncertaintyOptions& how,
                           Fit& fit) {
  Uncertainty out;
  const double prior = options.prior_weight / static_cast<double>(std::count(rows.begin(), rows.end(), true));
  const Eigen::Index n = std::ssize(free);
  const int per_round = 7 * static_cast<int>(n) + 10, planned = how.rounds * per_round;
  Eigen::MatrixXd spread = kFirstReach * kFirstReach * Eigen::MatrixXd::Identity(n, n);
  int done = 0;
  for (int round = 0; round < how.rounds; ++round) {
    const Eigen::VectorXd centre = fit.z;
    const Eigen::MatrixXd root = spread.llt().matrixL();
    for (int k = 0; k < per_round; ++k, ++done) {
      if (options.proceed && !options.proceed(static_cast<double>(done) / planned)) {
        out.interrupted = true;
        return out;
      }
      Eigen::VectorXd z = centre + root * normals(options.seed, 3, static_cast<std::uint32_t>(done), n);
      for (Eigen::Index i = 0; i < n; ++i) z[i] = std::clamp(z[i], free[i].z(free[i].lower), free[i].z(free[i].upper));
      fit.evaluations.push_back(evaluate(campaign, start, free, rows, options, z, options.trials));
    }
    const Sampler sampler(campaign, free, options, prior, fit, centre, spread);
    out.draws.resize(how.draws, n);
    for (int k = 0; k < how.draws; ++k) out.draws.row(k) = sampler.draw(static_cast<std::uint32_t>(k));
    out.noise = sampler.noise();
    const Eigen::VectorXd better = sampler.best(kTrust * spread.diagonal().cwiseSqrt());
    Evaluation tried = evaluate(campaign, start, free, rows, options, better, options.polish_trials);
    if (tried.objective < fit.objective) {
      fit.z = better;
      fit.objective = tried.objective;
      fit.model = model_at(start, free, better);
    }
    fit.evaluations.push_back(std::move(tried));
    spread = within(covariance_of(out.draws), kNarrow, kWide);
  }
  summarise(free, out);
  return out;
}

}  // namespace talus
