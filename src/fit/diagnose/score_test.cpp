#include "talus/fit/diagnose/score_test.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/diagnose/projection.hpp"
#include "talus/fit/diagnose/residual.hpp"

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

/// Signatures of all directions in which the model could move: how each changes the residuals of the blocks.
class Directions {
 public:
  /// @param unmoved  the base again, with the random numbers of the runs that will be added: their noise is the same in
  /// both
  Directions(const Campaign& campaign, const ResidualSpace& space, const std::vector<BlockRuns>& base,
             const std::vector<BlockRuns>& unmoved, const std::vector<bool>& rows)
      : space_(space), base_(base) {
    for (std::size_t b = 0; b < rows.size(); ++b)
      if (rows[b] && base[b].trials > 0) blocks_.push_back(b), streams_.push_back(campaign.blocks[b].stream);
    const MatrixXd x = covariates_of(campaign, blocks_);
    smoother_ = x * (x.transpose() * x + 1e-6 * MatrixXd::Identity(x.cols(), x.cols())).ldlt().solve(x.transpose());
    for (const std::size_t b : blocks_) rest_.push_back(mean_residual(space, b, unmoved[b]));
  }

  void add(const std::vector<BlockRuns>& moved) {
    MatrixXd signature(static_cast<Index>(blocks_.size()), space_.size());
    for (std::size_t i = 0; i < blocks_.size(); ++i)
      signature.row(static_cast<Index>(i)) = mean_residual(space_, blocks_[i], moved[blocks_[i]]) - rest_[i];
    signatures_.push_back(smoother_ * signature);
  }

  Index size() const { return static_cast<Index>(signatures_.size()); }
  std::span<const std::uint32_t> streams() const { return streams_; }

  /// Scores of a residual of block number i, by direction.
  VectorXd scores(std::size_t i, const VectorXd& whitened) const {
    VectorXd s(size());
    for (Index k = 0; k < size(); ++k)
      s[k] = signatures_[static_cast<std::size_t>(k)].row(static_cast<Index>(i)).dot(whitened);
    return s;
  }

  /// @param trials    by block: the scores of its base trials, one column each
  /// @param measured  the scores of the measurements, summed over the blocks
  void score_all(std::vector<MatrixXd>& trials, VectorXd& measured) const {
    measured = VectorXd::Zero(size());
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const BlockRuns& runs = base_[blocks_[i]];
      MatrixXd u(size(), runs.trials);
      for (std::size_t t = 0; t < runs.trials; ++t)
        u.col(static_cast<Index>(t)) = scores(i, space_.whitened(space_.of_own_trial(blocks_[i], runs, t)));
      const VectorXd mean = u.rowwise().mean();
      u.colwise() -= mean;
      measured += scores(i, space_.whitened(space_.of_measured(blocks_[i]))) - mean;
      trials.push_back(std::move(u));
    }
  }

 private:
  const ResidualSpace& space_;
  const std::vector<BlockRuns>& base_;
  std::vector<std::size_t> blocks_;
  std::vector<std::uint32_t> streams_;  // of the blocks
  MatrixXd smoother_;
  std::vector<VectorXd> rest_;        // by block: mean residual of the base itself, which is noise
  std::vector<MatrixXd> signatures_;  // by direction: blocks x components
};

/// The score of every direction in data set number `replicate`: one trial of each block stands in for what was
/// measured.
VectorXd drawn(const std::vector<MatrixXd>& trials, std::span<const std::uint32_t> streams, std::uint64_t seed,
               std::uint32_t replicate) {
  VectorXd scores = VectorXd::Zero(trials.front().rows());
  for (std::size_t b = 0; b < trials.size(); ++b) {
    const double place =
        draw_of_block(seed, streams[b], replicate, BlockDraw::Trial) * static_cast<double>(trials[b].cols());
    scores += trials[b].col(static_cast<Index>(place));
  }
  return scores;
}

/// The smallest p-value over the places of each effect, in data sets drawn from the model.
std::vector<std::vector<double>> smallest_drawn(std::size_t effects, const std::vector<Projection>& projections,
                                                const std::vector<std::size_t>& effect_of,
                                                const std::vector<MatrixXd>& trials,
                                                std::span<const std::uint32_t> streams,
                                                const ScoreTestOptions& options) {
  const auto n = static_cast<std::uint32_t>(options.replicates);
  std::vector<std::vector<double>> smallest(effects, std::vector<double>(n, 1.0));
  for (std::uint32_t replicate = 0; replicate < n; ++replicate) {
    if (replicate % 1000 == 999 && options.proceed && !options.proceed()) throw FitInterrupted{};
    const VectorXd scores = drawn(trials, streams, options.seed, replicate);
    for (std::size_t i = 0; i < projections.size(); ++i) {
      double& best = smallest[effect_of[i]][replicate];
      best = std::min(best, projections[i].verdict(scores).p_value);
    }
  }
  return smallest;
}

void correct(ScoreTest& test, std::vector<std::vector<double>> simulated) {
  std::vector<double> measured;
  for (const EffectVerdict& effect : test.effects) measured.push_back(effect.best.p_value);
  const Corrected p = corrected(simulated, measured);
  for (std::size_t e = 0; e < test.effects.size(); ++e) {
    test.effects[e].p_value = p.effects[e];
    test.effects[e].drawn = std::move(simulated[e]);
  }
  test.p_value = p.all;
}

/// Whether a is more significant; by the statistic where both p-values are too small for a double.
bool more_significant(const Verdict& a, const Verdict& b) {
  return a.p_value != b.p_value ? a.p_value < b.p_value : a.statistic > b.statistic;
}

/// Keeps a further place of an effect if it is the best or the second best.
void rank(const Verdict& verdict, EffectVerdict& effect) {
  if (more_significant(verdict, effect.best)) {
    effect.second = std::exchange(effect.best, verdict);
  } else if (effect.second.members.empty() || more_significant(verdict, effect.second)) {
    effect.second = verdict;
  }
}

/// Keeps a place of an effect for each parameter that is measured better there than at those before.
void sharpen(const Eigen::VectorXd& errors, const std::vector<std::size_t>& members, const Candidate& candidate,
             EffectVerdict& effect) {
  for (Index p = 0; p < errors.size(); ++p) {
    const auto parameter = static_cast<std::size_t>(p);
    Sharpest& sharpest = effect.sharpest[candidate.parameters[parameter].key];
    if (errors[p] < sharpest.standard_error) sharpest = {members, parameter, errors[p]};
  }
}

/// The step of a parameter of the base, away from its upper bound [z].
double step_of(const Parameter& parameter, double z, double size) {
  return parameter.value(z + size) < parameter.upper ? size : -size;
}

/// The directions of the base's parameters, then those of the candidates.
void add_directions(Directions& directions, const TestedModel& base, std::span<const Candidate> candidates,
                    const DiagnosisRules& rules, const std::function<std::vector<BlockRuns>(const Model&)>& observed) {
  for (std::size_t i = 0; i < base.free.size(); ++i) {
    VectorXd moved = base.z;
    moved[static_cast<Index>(i)] += step_of(base.free[i], base.z[static_cast<Index>(i)], rules.base_step);
    directions.add(observed(model_at(base.model, base.free, moved)));
  }
  for (const Candidate& candidate : candidates)
    for (std::size_t p = 0; p < candidate.tested; ++p) {
      VectorXd moved = VectorXd::Zero(static_cast<Index>(candidate.parameters.size()));
      moved[static_cast<Index>(p)] = rules.noticed;
      directions.add(observed(with(base.model, candidate, moved)));
    }
}

}  // namespace

Corrected corrected(std::span<const std::vector<double>> simulated, std::span<const double> measured) {
  // Number of data sets with a p-value of an effect as small, then that p-value: it decides between equal numbers of
  // two effects.
  using Rarity = std::pair<double, double>;
  const std::size_t n = simulated.front().size();
  const auto sets = static_cast<double>(n + 1);
  std::vector<Rarity> rarest(n, {sets, 1.0});  // by data set: by its most unlikely effect
  Rarity own{sets, 1.0};
  Corrected out;
  for (std::size_t e = 0; e < simulated.size(); ++e) {
    std::vector<double> sorted = simulated[e];
    sorted.push_back(measured[e]);
    std::sort(sorted.begin(), sorted.end());
    const auto rarity = [&sorted](double p) {
      return Rarity{std::upper_bound(sorted.begin(), sorted.end(), p) - sorted.begin(), p};
    };
    for (std::size_t set = 0; set < n; ++set) rarest[set] = std::min(rarest[set], rarity(simulated[e][set]));
    own = std::min(own, rarity(measured[e]));
    out.effects.push_back(rarity(measured[e]).first / sets);
  }
  const auto as_rare = std::count_if(rarest.begin(), rarest.end(), [&](const Rarity& r) { return r <= own; });
  out.all = (static_cast<double>(as_rare) + 1.0) / sets;
  return out;
}

ScoreTest score_test(const Campaign& campaign, const TestedModel& base, std::span<const Candidate> candidates,
                     const std::vector<bool>& rows, const ScoreTestOptions& options) {
  const auto observed = [&](const Model& model) {
    if (options.proceed && !options.proceed()) throw FitInterrupted{};
    return observe(campaign, model,
                   {.trials = options.trials,
                    .seed = options.seed,
                    .threads = options.threads,
                    .blocks = rows,
                    .effort = effort_of(options.rules.search),
                    .traced = options.traced});
  };
  const DiagnosisRules& rules = options.rules;
  const ResidualSpace space(campaign, base.runs, rules);
  Directions directions(campaign, space, base.runs, observed(base.model), rows);
  add_directions(directions, base, candidates, rules, observed);
  std::vector<MatrixXd> trials;
  VectorXd measured;
  directions.score_all(trials, measured);
  MatrixXd covariance = MatrixXd::Zero(directions.size(), directions.size());
  for (const MatrixXd& u : trials) covariance += u * u.transpose() / static_cast<double>(u.cols());

  const auto n_base = static_cast<Index>(base.free.size());
  VectorXd steps(n_base);
  for (Index i = 0; i < n_base; ++i)
    steps[i] = step_of(base.free[static_cast<std::size_t>(i)], base.z[i], rules.base_step);
  ScoreTest test;
  std::vector<Projection> projections;
  std::vector<std::size_t> effect_of;
  for (const TestedPlace& place : places_of(candidates, n_base, directions.size(), rules)) {
    projections.emplace_back(place, covariance, steps,
                             rules.base_step * rules.base_step / (rules.base_sd * rules.base_sd));
    Verdict verdict = projections.back().verdict(measured);
    verdict.members = place.members;
    const std::string& name = candidates[place.members.front()].effect;
    auto effect = std::find_if(test.effects.begin(), test.effects.end(),
                               [&](const EffectVerdict& e) { return e.effect == name; });
    if (effect == test.effects.end())
      effect = test.effects.insert(effect, {name, verdict, {}, 1.0, {}, {}});
    else
      rank(verdict, *effect);
    sharpen(projections.back().standard_errors(), place.members, candidates[place.members.front()], *effect);
    effect_of.push_back(static_cast<std::size_t>(effect - test.effects.begin()));
  }
  correct(test, smallest_drawn(test.effects.size(), projections, effect_of, trials, directions.streams(), options));
  std::sort(test.effects.begin(), test.effects.end(), [](const EffectVerdict& a, const EffectVerdict& b) {
    return a.p_value != b.p_value ? a.p_value < b.p_value : more_significant(a.best, b.best);
  });
  return test;
}

}  // namespace talus
