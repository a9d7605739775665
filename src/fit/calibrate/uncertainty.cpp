#include "talus/fit/calibrate/uncertainty.hpp"

#include <algorithm>

#include "local_model.hpp"
#include "talus/base/sample.hpp"

namespace talus {
namespace {

constexpr std::uint32_t kOwnDesigns = 10'000;  // places from this number on: no search uses them

void summarise(std::span<const Parameter> free, Uncertainty& out) {
  const Eigen::Index n = out.draws.cols();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto [low, high] = middle_of({out.draws.col(i).begin(), out.draws.col(i).end()});
    const Parameter& p = free[static_cast<std::size_t>(i)];
    out.intervals.push_back({p.value(low), p.value(high)});
    const double near = 1e-6;  // z of the bounds is rounded
    out.at_bound.push_back((-low > p.reach - near && low < p.z(p.lower) + near) ||
                           (high > p.reach - near && high > p.z(p.upper) - near));
    const double possible = std::min(2.0 * kTwoSided, p.z(p.upper) - p.z(p.lower));
    out.identifiable.push_back(high - low <= kMostOfThePrior * possible);
  }
  const Eigen::MatrixXd centred = out.draws.rowwise() - out.draws.colwise().mean();
  const Eigen::MatrixXd covariance = centred.transpose() * centred;
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  out.correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
}

}  // namespace

Uncertainty uncertainty_of(const FitProblem& problem, const FitOptions& options, const UncertaintyOptions& how,
                           const Fit& fit) {
  Uncertainty out;
  const Eigen::Index n = std::ssize(problem.free);
  const int length = LocalModel::round_length(n);
  Fit around = fit;
  around.evaluations.clear();  // a search dwells where noise lowered the objective: the optimum would look too sharp
  Eigen::MatrixXd spread = fit.spread;
  std::uint32_t done = 0;
  for (int round = 0; round < how.rounds; ++round) {
    const auto first = kOwnDesigns + done;
    for (const Eigen::VectorXd& z : LocalModel::design(problem, options.seed, fit.z, spread, length, first)) {
      if (options.proceed && !options.proceed(static_cast<double>(done) / (how.rounds * length))) {
        out.interrupted = true;
        return out;
      }
      const TrialRange own{options.trials, LocalModel::trials_of(kOwnDesigns + done++, options.trials)};
      around.evaluations.push_back(evaluate(problem, options, z, own));
    }
    if (round + 1 < how.rounds) spread = LocalModel(problem, options, around, spread).next_spread();
  }
  const LocalModel model(problem, options, around, spread);
  out.draws.resize(how.draws, n);
  for (int k = 0; k < how.draws; ++k) out.draws.row(k) = model.draw(static_cast<std::uint32_t>(k));
  out.noise = model.noise();
  summarise(problem.free, out);
  return out;
}

double effective_numbers(const Uncertainty& uncertainty) {
  const Eigen::MatrixXd& z = uncertainty.draws;
  if (z.rows() < 2) return 0.0;
  const Eigen::RowVectorXd mean = z.colwise().mean();
  const Eigen::RowVectorXd variance = (z.rowwise() - mean).colwise().squaredNorm() / static_cast<double>(z.rows() - 1);
  return (1.0 - variance.array()).max(0.0).sum();
}

}  // namespace talus
