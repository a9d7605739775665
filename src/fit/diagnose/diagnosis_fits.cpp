#include "diagnosis_fits.hpp"

namespace talus {

FitOptions search_options(const DiagnoseOptions& options, const std::function<bool(double)>& proceed) {
  FitOptions how;
  how.trials = options.trials.search;
  how.comparison_trials = 4 * options.trials.search;
  how.seed = options.seed;
  how.threads = options.threads;
  how.rules = options.rules.search;
  how.proceed = proceed;
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

std::uint32_t first_trial_of(const DiagnoseOptions& options, std::uint32_t round) {
  const DiagnosisRules& rules = options.rules;
  return kUnseen + round * (1 + 2 * rules.fold_orders + rules.confirming) * options.trials.compare;
}

std::vector<std::uint32_t> folds_of(std::span<const std::size_t> order, std::size_t blocks, std::size_t folds) {
  std::vector<std::uint32_t> fold_of(blocks, static_cast<std::uint32_t>(folds));
  for (std::size_t i = 0; i < order.size(); ++i) fold_of[order[i]] = static_cast<std::uint32_t>(i % folds);
  return fold_of;
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
