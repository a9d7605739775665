#pragma once
#include "talus/fit/calibrate/calibrate.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"

namespace talus {

/// Rules and steps that the fits to one campaign (EffectFits) and to several (JointFits) share.

/// The search of a fit with the trials of the diagnosis.
FitOptions search_options(const DiagnoseOptions& options, const std::function<bool(double)>& proceed);

/// The fit of a chosen model from where it is: a search, then rounds until one gains nothing.
FitOptions last_fit_options(FitOptions how, const DiagnosisRules& rules);

/// Number of the first trial of a round. No two rounds share a trial: each has those that compare fits once for the
/// choice, once for each order of its cross-validation, as often to confirm that, and `confirming` times to confirm the
/// objective.
std::uint32_t first_trial_of(const DiagnoseOptions& options, std::uint32_t round);

/// Cuts an order of blocks into folds. @return the fold of each block; `folds` for a block that is not in the order
std::vector<std::uint32_t> folds_of(std::span<const std::size_t> order, std::size_t blocks, std::size_t folds);

/// Sets the amount of an effect. @param z  of all parameters of its fit, its own last
void set_amount(FittedEffect& effect, const Eigen::VectorXd& z, const DiagnosisRules& rules);

/// Sets the gain of an effect on the fitting rows. @param streams  of all blocks
void set_gain(FittedEffect& effect, const Score& base, const Score& own, std::span<const std::uint32_t> streams);

/// Sets the gain in cross-validation. @param base, own  scores of the same folds and trials
void set_cross_validated(FittedEffect& effect, std::span<const Score> base, std::span<const Score> own,
                         std::span<const std::uint32_t> streams);

/// The fit with the lower objective, with the evaluations of the longer one.
template <class Fitted>
Fitted better_of(Fitted before, Fitted longer) {
  if (longer.objective.total < before.objective.total) return longer;
  before.evaluations = std::move(longer.evaluations);
  return before;
}

}  // namespace talus
