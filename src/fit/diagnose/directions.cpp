#include "directions.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <set>

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Mean residual of the trials of one block; zero where fewer than five were seen.
VectorXd mean_residual(const ResidualSpace& space, std::size_t block, const BlockRuns& runs) {
  VectorXd sum = VectorXd::Zero(space.size()), seen = sum;
  for (std::size_t t = 0; t < runs.trials; ++t) {
    const Residual r = space.of_trial(block, runs, t);
    for (Index i = 0; i < r.size(); ++i)
      if (!std::isnan(r[i])) sum[i] += r[i], seen[i] += 1.0;
  }
  for (Index i = 0; i < seen.size(); ++i) sum[i] = seen[i] >= 5.0 ? sum[i] / seen[i] : 0.0;
  return sum;
}

/// Properties of the blocks that a signature may depend on: a constant, mass, shape, place of release, day.
MatrixXd covariates_of(const Campaign& campaign, const std::vector<std::size_t>& blocks) {
  constexpr Index kContinuous = 7;
  std::set<int> days;
  for (const std::size_t b : blocks) days.insert(campaign.blocks[b].day);
  const auto n = static_cast<Index>(blocks.size());
  MatrixXd x(n, kContinuous + std::ssize(days) - 1);
  for (Index i = 0; i < n; ++i) {
    const MeasuredBlock& b = campaign.blocks[blocks[static_cast<std::size_t>(i)]];
    x.row(i).head(kContinuous) << 1.0, std::log(b.mass), std::log(b.axes.x() / b.axes.z()),
        std::log(b.axes.x() / b.axes.y()), b.x, b.y, b.release_height;
    Index column = kContinuous;
    for (auto day = std::next(days.begin()); day != days.end(); ++day) x(i, column++) = b.day == *day ? 1.0 : 0.0;
  }
  for (Index j = 1; j < x.cols(); ++j) {
    x.col(j).array() -= x.col(j).mean();
    const double norm = x.col(j).norm() / std::sqrt(static_cast<double>(n));
    x.col(j) = norm > 1e-9 ? VectorXd(x.col(j) / norm) : VectorXd(VectorXd::Zero(n));
  }
  return x;
}

/// The step of a parameter of the base, away from its upper bound [z].
double step_of(const Parameter& parameter, double z, double size) {
  return parameter.value(z + size) < parameter.upper ? size : -size;
}

}  // namespace

Directions::Directions(const Campaign& campaign, const ResidualSpace& space, const std::vector<BlockRuns>& base,
                       const std::vector<BlockRuns>& unmoved, const std::vector<bool>& rows)
    : space_(space), base_(base) {
  for (std::size_t b = 0; b < rows.size(); ++b)
    if (rows[b] && base[b].trials > 0) blocks_.push_back(b), streams_.push_back(campaign.blocks[b].stream);
  const MatrixXd x = covariates_of(campaign, blocks_);
  smoother_ = x * (x.transpose() * x + 1e-6 * MatrixXd::Identity(x.cols(), x.cols())).ldlt().solve(x.transpose());
  for (const std::size_t b : blocks_) rest_.push_back(mean_residual(space, b, unmoved[b]));
}

void Directions::add(const std::vector<BlockRuns>& moved) {
  MatrixXd signature(static_cast<Index>(blocks_.size()), space_.size());
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    signature.row(static_cast<Index>(i)) = mean_residual(space_, blocks_[i], moved[blocks_[i]]) - rest_[i];
  signatures_.push_back(smoother_ * signature);
}

VectorXd Directions::add_free(const TestedModel& base, const Observer& observed, const DiagnosisRules& rules) {
  VectorXd steps(std::ssize(base.free));
  for (Index i = 0; i < steps.size(); ++i) {
    steps[i] = step_of(base.free[static_cast<std::size_t>(i)], base.z[i], rules.base_step);
    VectorXd moved = base.z;
    moved[i] += steps[i];
    add(observed(model_at(base.model, base.free, moved)));
  }
  return steps;
}

MatrixXd Directions::measured() const {
  MatrixXd residuals(space_.size(), std::ssize(blocks_));
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    residuals.col(static_cast<Index>(i)) = space_.of_measured(blocks_[i]);
  return residuals;
}

std::vector<MatrixXd> Directions::trials_of(const std::vector<BlockRuns>& moved) const {
  std::vector<MatrixXd> trials;
  for (const std::size_t block : blocks_) {
    trials.emplace_back(space_.size(), moved[block].trials);
    for (Index t = 0; t < trials.back().cols(); ++t)
      trials.back().col(t) = space_.of_trial(block, moved[block], static_cast<std::size_t>(t));
  }
  return trials;
}

MatrixXd Directions::scores_of(std::size_t i, const MatrixXd& trials) const {
  MatrixXd scores(size(), trials.cols());
  for (Index t = 0; t < trials.cols(); ++t) {
    const VectorXd whitened = space_.whitened(trials.col(t));
    for (Index k = 0; k < size(); ++k)
      scores(k, t) = signatures_[static_cast<std::size_t>(k)].row(static_cast<Index>(i)).dot(whitened);
  }
  return scores;
}

CampaignScores Directions::scores() const {
  CampaignScores out;
  out.measured = VectorXd::Zero(size());
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const BlockRuns& base = base_[blocks_[i]];
    MatrixXd trials(space_.size(), base.trials);
    for (Index t = 0; t < trials.cols(); ++t)
      trials.col(t) = space_.of_own_trial(blocks_[i], base, static_cast<std::size_t>(t));
    out.trials.push_back(scores_of(i, trials));
    out.means.emplace_back(out.trials.back().rowwise().mean());
    out.trials.back().colwise() -= out.means.back();
    out.measured += scores_of(i, space_.of_measured(blocks_[i])) - out.means.back();
  }
  return out;
}

MatrixXd covariance_of(const std::vector<MatrixXd>& trials) {
  MatrixXd covariance = MatrixXd::Zero(trials.front().rows(), trials.front().rows());
  for (const MatrixXd& u : trials) covariance += u * u.transpose() / static_cast<double>(u.cols());
  return covariance;
}

}  // namespace talus
