#pragma once
#include <cstdint>

#include "fit/calibrate/local_model.hpp"
#include "talus/fit/calibrate/calibrate.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"
#include "talus/fit/diagnose/score_test.hpp"

namespace talus {

/// Rules and steps that the fits to one campaign (EffectFits) and to several (JointFits) share.

/// The search of a fit with the trials of the diagnosis.
FitOptions search_options(const DiagnoseOptions& options, const std::function<bool(double)>& proceed);

/// The fit of a chosen model from where it is: a search, then rounds until one gains nothing.
FitOptions last_fit_options(FitOptions how, const DiagnosisRules& rules);

/// The score test with the trials of the diagnosis.
///
/// @param families  number of families over which p is corrected
ScoreTestOptions score_test_options(const DiagnoseOptions& options, std::size_t families,
                                    std::function<bool()> proceed);

/// Number of the first trial of a round. No two rounds share a trial: each has those that compare fits once for the
/// choice, once for each order of its cross-validation, as often to confirm that, and `confirming` times to confirm the
/// objective.
std::uint32_t first_trial_of(const DiagnoseOptions& options, std::uint32_t round);

/// Cuts an order of blocks into folds. @return the fold of each block; `folds` for a block that is not in the order
std::vector<std::uint32_t> folds_of(std::span<const std::size_t> order, std::size_t blocks, std::size_t folds);

/// A score of all sites of a problem. @param how  folds: of the blocks of all sites, one site after the other
Score joined_score(const FitProblem& problem, const std::vector<std::vector<BlockRuns>>& runs, ScoreOptions how);

/// Purpose of a cross-validation: to choose an effect, or to confirm the choice with other trials.
enum class Judges : std::uint8_t { Choice, Confirmation };

/// Simulates blocks out of their folds: each by the minimum of the quadratic model of the other folds' rows. The parts
/// must outlive it.
class OutOfFold {
 public:
  /// @param fitted  a fit of the problem
  template <class Fitted>
  OutOfFold(const FitProblem& problem, const FitOptions& options, const Fitted& fitted)
      : problem_(problem),
        options_(options),
        spread_(fitted.spread),
        local_(problem, options, EndOfFit{fitted.z, fitted.objective, fitted.evaluations}, fitted.spread) {}

  /// Runs by site, of every block with a fold. Throws FitInterrupted.
  ///
  /// @param fold_of  by block, numbered on from site to site: below `folds`, else the block is left out
  std::vector<std::vector<BlockRuns>> runs(ObserveOptions how, std::span<const std::uint32_t> fold_of,
                                           std::size_t folds) const;
  /// The objective for each of some random orders of the blocks, cut into folds.
  ///
  /// @param round  first trial of the round of the fits
  std::vector<Score> objectives(const DiagnoseOptions& options, std::uint32_t round, Judges judges) const;

 private:
  const FitProblem& problem_;
  const FitOptions& options_;
  const Eigen::MatrixXd& spread_;
  LocalModel local_;
};

/// Start of the fit of an effect, in units of what one would notice: the estimate of the score test, cut to 0.3 to 4,
/// or to -2 to 4 where the amount may be negative.
double first_amount(const Parameter& parameter, double estimate);

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
