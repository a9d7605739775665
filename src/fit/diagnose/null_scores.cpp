#include "null_scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/calibrate/normal_draws.hpp"
#include "talus/fit/campaign/block_draws.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How far down the upper limit of `shape` can go in every zone [-].
double room_below(const Model& model) {
  double room = std::numeric_limits<double>::infinity();
  for (const Ground& ground : model.grounds) room = std::min(room, ground.shape_max - ground.shape_min);
  return room;
}

/// A data set: of each block one of its trials, the same of its residuals and of its scores. One column each.
MatrixXd drawn_set(const std::vector<MatrixXd>& trials, std::span<const std::uint32_t> streams, std::uint64_t seed,
                   std::uint32_t set) {
  MatrixXd drawn(trials.front().rows(), std::ssize(trials));
  for (std::size_t b = 0; b < trials.size(); ++b) {
    const double place = draw_of_block(seed, streams[b], set, BlockDraw::Trial) * static_cast<double>(trials[b].cols());
    drawn.col(static_cast<Index>(b)) = trials[b].col(static_cast<Index>(place));
  }
  return drawn;
}

}  // namespace

OpenGrounds::OpenGrounds(const TestedModel& base, const VectorXd& steps, const CampaignScores& scores,
                         const MatrixXd& covariance, const DiagnosisRules& rules)
    : base_(base), shape_step_(rules.other_shape) {
  const Index n = steps.size();
  MatrixXd precision = covariance.topLeftCorner(n + 1, n + 1);
  precision.diagonal().array() += step_prior(rules);
  root_.compute(precision);
  units_ = VectorXd::Ones(n + 1);
  units_.head(n) = steps;
  centre_ = units_.cwiseProduct(root_.solve(scores.measured.head(n + 1)));
  room_.resize(n + 1);
  for (Index i = 0; i <= n; ++i) {
    double low = -room_below(base.model) / shape_step_, high = std::numeric_limits<double>::infinity();
    if (i < n) {
      const Parameter& p = base.free[static_cast<std::size_t>(i)];
      low = p.z(p.lower) - base.z[i], high = p.z(p.upper) - base.z[i];
    }
    centre_[i] = std::clamp(std::clamp(centre_[i], -rules.longest_move, rules.longest_move), low, high);
    room_[i] = std::min(centre_[i] - low, high - centre_[i]);
  }
}

Model OpenGrounds::model(std::uint64_t seed, std::uint32_t number) const {
  const VectorXd normal = normal_draws(seed, NormalDraw::OpenGround, number / 2, units_.size());
  const VectorXd away = units_.cwiseProduct(root_.matrixU().solve(normal)).cwiseMin(room_).cwiseMax(-room_);
  const VectorXd move = centre_ + (number % 2 == 0 ? away : VectorXd(-away));
  const Index n = base_.z.size();
  Model model = model_at(base_.model, base_.free, base_.z + move.head(n));
  for (Ground& ground : model.grounds) ground.shape_max += shape_step_ * move[n];
  return model;
}

NullSets null_sets(const OpenGrounds& grounds, const Directions& directions, const std::vector<VectorXd>& means,
                   const Scatters& scatters, const TrialObserver& observed, const ScoreTestOptions& options) {
  const auto sets = static_cast<std::uint32_t>(options.replicates);
  NullSets out{MatrixXd(directions.size(), sets), VectorXd::Zero(directions.size()),
               MatrixXd(std::ssize(scatters.kinds()), sets)};
  if (sets == 0) return out;
  const auto count = static_cast<std::uint32_t>(options.rules.open_grounds);
  const std::uint32_t trials = std::max(4U, options.trials / 16);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t first = kUnseen - (k + 1) * trials;  // no search has used them
    const auto residuals = directions.trials_of(observed(grounds.model(options.seed, k), trials, first));
    std::vector<MatrixXd> scores;
    for (std::size_t b = 0; b < residuals.size(); ++b) {
      scores.push_back(directions.scores_of(b, residuals[b]).colwise() - means[b]);
      out.mean += scores.back().rowwise().mean() / static_cast<double>(count);
    }
    for (std::uint32_t set = k; set < sets; set += count) {
      out.scores.col(set) = drawn_set(scores, directions.streams(), options.seed, set).rowwise().sum();
      out.scatters.col(set) = scatters.of(drawn_set(residuals, directions.streams(), options.seed, set));
    }
  }
  out.scores.colwise() -= out.mean;
  return out;
}

}  // namespace talus
