#include "diagnosis_fits.hpp"

#include <algorithm>

#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/score/joined_scores.hpp"

namespace talus {

FitOptions search_options(const DiagnoseOptions& options, const std::function<bool(double)>& proceed) {
  FitOptions how;
  how.trials = options.trials.search;
  how.comparison_trials = 4 * options.trials.search;
  how.seed = options.seed;
  how.threads = options.threads;
  how.rules = options.rules.search;
  how.proceed = proceed;
  how.traced = options.traced;
  return how;
}

FitOptions last_fit_options(FitOptions how, const DiagnosisRules& rules) {
  how.trials *= 2;
  how.comparison_trials *= 2;
  how.starts = 1;
  how.rounds = rules.last_rounds;
  how.enough = rules.worth_a_round;
  return how;
}

ScoreTestOptions score_test_options(const DiagnoseOptions& options, std::size_t families,
                                    std::function<bool()> proceed) {
  ScoreTestOptions how;
  how.trials = options.trials.test;
  how.seed = options.seed;
  how.threads = options.threads;
  how.replicates = options.replicates(families);
  how.rules = options.rules;
  how.proceed = std::move(proceed);
  how.traced = options.traced;
  return how;
}

std::uint32_t first_trial_of(const DiagnoseOptions& options, std::uint32_t round) {
  const DiagnosisRules& rules = options.rules;
  return kUnseen + round * (1 + 2 * rules.fold_orders + rules.confirming) * options.trials.compare;
}

std::vector<std::uint32_t> folds_of(std::span<const std::size_t> order, std::size_t blocks, std::size_t folds) {
  std::vector<std::uint32_t> fold_of(blocks, static_cast<std::uint32_t>(folds));
  for (std::size_t i = 0; i < order.size(); ++i) fold_of[order[i]] = static_cast<std::uint32_t>(i % folds);
  return fold_of;
}

Score joined_score(const FitProblem& problem, const std::vector<std::vector<BlockRuns>>& runs, ScoreOptions how) {
  const std::vector<std::uint32_t> folds = std::move(how.folds);
  std::vector<SiteScore> scores;
  std::size_t before = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const FitSite& site = problem.sites[i];
    const std::size_t blocks = site.rows.size();
    if (!folds.empty()) {
      const auto own = std::span(folds).subspan(before, blocks);
      how.folds.assign(own.begin(), own.end());
    }
    scores.push_back({site.name, score(site.campaign, runs[i], site.rows, how), blocks});
    before += blocks;
  }
  return joined_scores(scores);
}

std::vector<std::vector<BlockRuns>> OutOfFold::runs(ObserveOptions how, std::span<const std::uint32_t> fold_of,
                                                    std::size_t folds) const {
  std::vector<std::vector<BlockRuns>> out;
  for (const FitSite& site : problem_.sites) out.emplace_back(site.rows.size());
  for (std::size_t fold = 0; fold < folds; ++fold) {
    if (!options_.proceed(1.0)) throw FitInterrupted{};
    std::vector<double> others(fold_of.size(), 1.0);
    for (std::size_t b = 0; b < others.size(); ++b)
      if (fold_of[b] == fold) others[b] = 0.0;
    const std::vector<Model> models = problem_.models(local_.optimum(others, spread_));
    std::size_t before = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      how.blocks.assign(out[i].size(), false);
      for (std::size_t b = 0; b < out[i].size(); ++b) how.blocks[b] = fold_of[before + b] == fold;
      std::vector<BlockRuns> seen = observe(problem_.sites[i].campaign, models[i], how);
      for (std::size_t b = 0; b < seen.size(); ++b)
        if (how.blocks[b]) out[i][b] = std::move(seen[b]);
      before += out[i].size();
    }
  }
  return out;
}

std::vector<Score> OutOfFold::objectives(const DiagnoseOptions& options, std::uint32_t round, Judges judges) const {
  const DiagnosisRules& rules = options.rules;
  const std::uint32_t before = judges == Judges::Confirmation ? rules.fold_orders : 0;  // orders of the choice
  const std::vector<std::uint32_t> streams = problem_.streams();
  const std::vector<bool> rows = problem_.rows();
  ObserveOptions how{.trials = options.trials.compare,
                     .seed = options.seed,
                     .threads = options.threads,
                     .effort = effort_of(rules.search),
                     .traced = options.traced};
  ScoreOptions scoring = fit_scoring();
  std::vector<Score> scores;
  for (std::uint32_t number = 0; number < rules.fold_orders; ++number) {
    how.first_trial = round + (1 + before + number) * how.trials;  // new ones for each
    scoring.folds = folds_of(random_order(streams, rows, options.seed, number), rows.size(), rules.folds);
    scores.push_back(weigh_groups(joined_score(problem_, runs(how, scoring.folds, rules.folds), scoring)));
  }
  return scores;
}

double first_amount(const Parameter& parameter, double estimate) {
  return std::clamp(estimate, parameter.one_sided() ? 0.3 : -2.0, 4.0);
}

void set_amount(FittedEffect& effect, const Eigen::VectorXd& z, const DiagnosisRules& rules) {
  const auto own = z.tail(std::ssize(effect.parameters));
  effect.amount = own.head(static_cast<Eigen::Index>(effect.tested)).cwiseAbs().maxCoeff() / rules.noticed;
}

void set_gain(FittedEffect& effect, const Score& base, const Score& own, std::span<const std::uint32_t> streams) {
  const Difference change = difference(base, own, streams);
  effect.gain = 0.0 - change.mean;  // not -0
  effect.gain_interval = {-change.interval.high, -change.interval.low};
}

void set_cross_validated(FittedEffect& effect, std::span<const Score> base, std::span<const Score> own,
                         std::span<const std::uint32_t> streams) {
  const Difference change = mean_difference(base, own, streams);
  effect.cross_validated = -change.mean;
  effect.cross_validated_interval = {-change.interval.high, -change.interval.low};
}

}  // namespace talus
