#include "talus/fit/score_test.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "talus/base/random.hpp"

namespace talus {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostJoined = 4;  // neighbouring bands
constexpr double kStep = 0.5;   // by which a parameter of the base is moved [z]

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

/// What a signature may depend on, from block to block: a constant, mass, shape, place of release, day.
MatrixXd covariates_of(const Campaign& campaign, const std::vector<std::size_t>& blocks) {
  const auto n = static_cast<Index>(blocks.size());
  MatrixXd x(n, 8);
  for (Index i = 0; i < n; ++i) {
    const MeasuredBlock& b = campaign.blocks[blocks[static_cast<std::size_t>(i)]];
    x.row(i) << 1.0, std::log(b.mass), std::log(b.axes.x() / b.axes.z()), std::log(b.axes.x() / b.axes.y()), b.x, b.y,
        b.release_height, static_cast<double>(b.day);
  }
  for (Index j = 1; j < x.cols(); ++j) {
    x.col(j).array() -= x.col(j).mean();
    const double norm = x.col(j).norm() / std::sqrt(static_cast<double>(n));
    x.col(j) = norm > 1e-9 ? VectorXd(x.col(j) / norm) : VectorXd(VectorXd::Zero(n));
  }
  return x;
}

/// All directions in which the model could move, seen through the residuals of the blocks.
class Directions {
 public:
  Directions(const Campaign& campaign, const ResidualSpace& space, const std::vector<BlockRuns>& base,
             const std::vector<bool>& rows)
      : space_(space), base_(base) {
    for (std::size_t b = 0; b < rows.size(); ++b)
      if (rows[b] && base[b].trials > 0) blocks_.push_back(b);
    const MatrixXd x = covariates_of(campaign, blocks_);
    smoother_ = x * (x.transpose() * x + 1e-6 * MatrixXd::Identity(x.cols(), x.cols())).ldlt().solve(x.transpose());
    for (const std::size_t b : blocks_) rest_.push_back(mean_residual(space, b, base[b]));
  }

  void add(const std::vector<BlockRuns>& moved) {
    MatrixXd signature(static_cast<Index>(blocks_.size()), space_.size());
    for (std::size_t i = 0; i < blocks_.size(); ++i)
      signature.row(static_cast<Index>(i)) = mean_residual(space_, blocks_[i], moved[blocks_[i]]) - rest_[i];
    signatures_.push_back(smoother_ * signature);
  }

  Index size() const { return static_cast<Index>(signatures_.size()); }

  /// Scores of a residual of block number i, by direction.
  VectorXd scores(std::size_t i, const VectorXd& whitened) const {
    VectorXd s(size());
    for (Index k = 0; k < size(); ++k)
      s[k] = signatures_[static_cast<std::size_t>(k)].row(static_cast<Index>(i)).dot(whitened);
    return s;
  }

  /// By block: the scores of its base trials, one column each. Of what was measured: one column per block.
  void score_all(std::vector<MatrixXd>& trials, MatrixXd& measured) const {
    measured = MatrixXd::Zero(size(), static_cast<Index>(blocks_.size()));
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const BlockRuns& runs = base_[blocks_[i]];
      MatrixXd u(size(), runs.trials);
      for (std::size_t t = 0; t < runs.trials; ++t)
        u.col(static_cast<Index>(t)) = scores(i, space_.whitened(space_.of_trial(blocks_[i], runs, t)));
      const VectorXd mean = u.rowwise().mean();
      u.colwise() -= mean;
      measured.col(static_cast<Index>(i)) = scores(i, space_.whitened(space_.of_measured(blocks_[i]))) - mean;
      trials.push_back(std::move(u));
    }
  }

 private:
  const ResidualSpace& space_;
  const std::vector<BlockRuns>& base_;
  std::vector<std::size_t> blocks_;
  MatrixXd smoother_;
  std::vector<VectorXd> rest_;        // by block: mean residual of the base itself, nearly zero
  std::vector<MatrixXd> signatures_;  // by direction: blocks x components
};

/// A place where an effect is tested: which directions, summed up to its parameters.
struct Place {
  std::size_t candidate, joined;
  MatrixXd pick;  // directions x tested parameters
};

std::vector<Place> places_of(std::span<const Candidate> candidates, Index base, Index directions) {
  std::vector<Place> places;
  std::vector<Index> first(candidates.size());
  Index next = base;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    first[c] = next;
    next += static_cast<Index>(candidates[c].tested);
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const int most = candidates[c].effect == "undeclared-zone" ? kMostJoined : 1;
    for (int joined = 1; joined <= most; ++joined) {
      const std::size_t last = c + static_cast<std::size_t>(joined) - 1;
      if (last >= candidates.size() || candidates[last].effect != candidates[c].effect) break;
      MatrixXd pick = MatrixXd::Zero(directions, static_cast<Index>(candidates[c].tested));
      for (std::size_t j = c; j <= last; ++j)
        for (Index p = 0; p < pick.cols(); ++p) pick(first[j] + p, p) = 1.0;
      places.push_back({c, static_cast<std::size_t>(joined), std::move(pick)});
    }
  }
  return places;
}

double chi_squared_tail(double statistic, Index freedom) {
  const boost::math::chi_squared distribution(static_cast<double>(freedom));
  return boost::math::cdf(boost::math::complement(distribution, std::max(0.0, statistic)));
}

/// The linear map from scores to one place's effective score.
struct Projection {
  MatrixXd map;  // tested parameters x directions
  MatrixXd information;
  VectorXd steps;  // by which the base's parameters were moved [z]
  bool one_sided = false;

  /// By the larger of two statistics: with the variance that the model gives, and with that of the blocks' own
  /// contributions, so that a model which scatters too much does not hide an effect. The simulated data sets go through
  /// the same choice.
  Verdict verdict(const MatrixXd& scores) const {
    Verdict v;
    MatrixXd parts = map * scores;  // tested parameters x blocks
    const VectorXd s = parts.rowwise().sum();
    parts.colwise() -= s / static_cast<double>(parts.cols());
    MatrixXd variance = parts * parts.transpose();
    variance.diagonal().array() += 1e-9;
    v.estimate = information.ldlt().solve(s);
    v.ground = steps.cwiseProduct(map.leftCols(steps.size()).transpose() * v.estimate);
    v.statistic = std::max(s.dot(v.estimate), s.dot(variance.ldlt().solve(s)));
    v.p_value = chi_squared_tail(v.statistic, s.size());
    if (one_sided) v.p_value = s[0] > 0.0 ? 0.5 * v.p_value : 1.0;
    return v;
  }
};

/// Takes out of a place's score what the free parameters of the base explain: a regression on their scores.
Projection project(const Place& place, const MatrixXd& covariance, const VectorXd& steps, double prior,
                   bool one_sided) {
  const Index base = steps.size();
  MatrixXd information = covariance.topLeftCorner(base, base);
  information.diagonal().array() += prior;
  MatrixXd imitated = MatrixXd::Zero(place.pick.cols(), covariance.rows());
  imitated.leftCols(base) = information.ldlt().solve(covariance.topRows(base) * place.pick).transpose();
  Projection p;
  p.map = place.pick.transpose() - imitated;
  p.information = p.map * covariance * p.map.transpose();
  p.information.diagonal().array() += 1e-9;
  p.steps = steps;
  p.one_sided = one_sided;
  return p;
}

/// Corrects p-values for the number of places and effects by data sets drawn from the model.
void correct(ScoreTest& test, const std::vector<Projection>& projections, const std::vector<std::size_t>& effect_of,
             const std::vector<MatrixXd>& trials, const ScoreTestOptions& options) {
  std::vector<int> more_extreme(test.effects.size(), 0);
  int any = 0;
  double best = 1.0;
  for (const EffectVerdict& e : test.effects) best = std::min(best, e.best.p_value);
  for (int replicate = 0; replicate < options.replicates; ++replicate) {
    MatrixXd scores(trials.front().rows(), static_cast<Index>(trials.size()));
    for (std::size_t b = 0; b < trials.size(); ++b) {
      const Words words =
          Random(options.seed, static_cast<std::uint32_t>(replicate), static_cast<std::uint32_t>(b), Purpose::Bootstrap)
              .words(0);
      scores.col(static_cast<Index>(b)) =
          trials[b].col(static_cast<Index>(uniform(words[0]) * static_cast<double>(trials[b].cols())));
    }
    std::vector<double> smallest(test.effects.size(), 1.0);
    for (std::size_t i = 0; i < projections.size(); ++i)
      smallest[effect_of[i]] = std::min(smallest[effect_of[i]], projections[i].verdict(scores).p_value);
    for (std::size_t e = 0; e < smallest.size(); ++e) more_extreme[e] += smallest[e] <= test.effects[e].best.p_value;
    any += *std::min_element(smallest.begin(), smallest.end()) <= best;
  }
  for (std::size_t e = 0; e < test.effects.size(); ++e)
    test.effects[e].p_value = (more_extreme[e] + 1.0) / (options.replicates + 1.0);
  test.p_value = (any + 1.0) / (options.replicates + 1.0);
}

/// By how much a parameter of the base is moved: away from its upper bound [z].
double step_of(const Parameter& parameter, double z) {
  return parameter.value(z + kStep) < parameter.upper ? kStep : -kStep;
}

Directions directions_of(const Campaign& campaign, const ResidualSpace& space, const Model& base,
                         std::span<const Parameter> free, const VectorXd& z, const std::vector<BlockRuns>& base_runs,
                         std::span<const Candidate> candidates, const std::vector<bool>& rows,
                         const ScoreTestOptions& options) {
  Directions directions(campaign, space, base_runs, rows);
  const ObserveOptions observing{options.trials, options.seed, 0, options.threads, rows, {}};
  for (std::size_t i = 0; i < free.size(); ++i) {
    VectorXd moved = z;
    moved[static_cast<Index>(i)] += step_of(free[i], z[static_cast<Index>(i)]);
    directions.add(observe(campaign, model_at(base, free, moved), observing));
  }
  for (const Candidate& candidate : candidates)
    for (std::size_t p = 0; p < candidate.tested; ++p) {
      VectorXd moved = VectorXd::Zero(static_cast<Index>(candidate.parameters.size()));
      moved[static_cast<Index>(p)] = kNoticed;
      directions.add(observe(campaign, with(base, candidate, moved), observing));
    }
  return directions;
}

}  // namespace

ScoreTest score_test(const Campaign& campaign, const Model& base, std::span<const Parameter> free, const VectorXd& z,
                     const std::vector<BlockRuns>& base_runs, std::span<const Candidate> candidates,
                     const std::vector<bool>& rows, const ScoreTestOptions& options) {
  const ResidualSpace space(campaign, base_runs);
  const Directions directions = directions_of(campaign, space, base, free, z, base_runs, candidates, rows, options);
  std::vector<MatrixXd> trials;
  MatrixXd measured;
  directions.score_all(trials, measured);
  MatrixXd covariance = MatrixXd::Zero(directions.size(), directions.size());
  for (const MatrixXd& u : trials) covariance += u * u.transpose() / static_cast<double>(u.cols());

  const auto n_base = static_cast<Index>(free.size());
  VectorXd steps(n_base);
  for (Index i = 0; i < n_base; ++i) steps[i] = step_of(free[static_cast<std::size_t>(i)], z[i]);
  ScoreTest test;
  std::vector<Projection> projections;
  std::vector<std::size_t> effect_of;
  for (const Place& place : places_of(candidates, n_base, directions.size())) {
    const Candidate& candidate = candidates[place.candidate];
    const bool one_sided = candidate.tested == 1 && candidate.parameters[0].lower >= 0.0;
    projections.push_back(
        project(place, covariance, steps, kStep * kStep / (options.prior_sd * options.prior_sd), one_sided));
    Verdict verdict = projections.back().verdict(measured);
    verdict.candidate = place.candidate;
    verdict.joined = place.joined;
    auto effect = std::find_if(test.effects.begin(), test.effects.end(),
                               [&](const EffectVerdict& e) { return e.effect == candidate.effect; });
    if (effect == test.effects.end()) effect = test.effects.insert(effect, {candidate.effect, verdict, 1.0, {}});
    if (verdict.p_value < effect->best.p_value) effect->best = verdict;
    effect->places.push_back(verdict);
    effect_of.push_back(static_cast<std::size_t>(effect - test.effects.begin()));
  }
  correct(test, projections, effect_of, trials, options);
  for (EffectVerdict& effect : test.effects)
    std::sort(effect.places.begin(), effect.places.end(),
              [](const Verdict& a, const Verdict& b) { return a.p_value < b.p_value; });
  std::sort(test.effects.begin(), test.effects.end(), [](const EffectVerdict& a, const EffectVerdict& b) {
    return a.p_value != b.p_value ? a.p_value < b.p_value : a.best.p_value < b.best.p_value;
  });
  return test;
}

}  // namespace talus
