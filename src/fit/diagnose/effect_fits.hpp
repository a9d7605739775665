#pragma once
#include "diagnosis_fits.hpp"
#include "talus/fit/diagnose/score_test.hpp"

namespace talus {

/// The fits of one diagnosis: of the ground, and of each effect on top of the model so far.
///
/// Each fit passes its evaluations on to the next one, so that an effect is added to a ground whose neighbourhood is
/// known. docs/closing-the-loop.md, "Diagnosis".
class EffectFits {
 public:
  /// @param proceed  called now and then with the share of the fit that is done; false: FitInterrupted is thrown
  EffectFits(const Campaign& campaign, const DiagnoseOptions& options, const std::vector<bool>& rows,
             std::function<bool(double)> proceed)
      : campaign_(campaign), options_(options), rows_(rows), proceed_(std::move(proceed)) {}

  /// Begins a round, in which fits are compared with random numbers that no earlier round has used.
  /// @return the base of the round, simulated anew
  FittedModel begin_round(FittedModel base);
  /// The trials of the round in another campaign of the same blocks (further screens).
  std::vector<BlockRuns> observed_in(const Campaign& campaign, const Model& model) const;
  /// Simulates and scores a fit again, with the random numbers of this round.
  FittedModel simulated_anew(FittedModel fitted) const;
  /// The ground alone, fitted as `calibrate` does, then for some rounds more: what this fit misses looks like an
  /// effect.
  ///
  /// @param brief  with as many trials as other fits, not twice as many
  FittedModel fit_ground(const Model& start, bool brief = false) const;
  /// An effect at its best place, fitted from the estimate of the score test; together with the ground where it may be
  /// chosen.
  ///
  /// @param family  by which it may be chosen; empty: it may not
  FittedCandidate fit_effect(const FittedModel& base, const EffectVerdict& verdict, const Candidate& candidate,
                             const std::string& family) const;
  /// The least objective over some amounts of an effect, to compare its places.
  double least_objective(const FittedModel& base, const Verdict& verdict, const Candidate& candidate) const;
  /// Continues the fit of an effect; keeps the result where it is better.
  void continue_fit(const FittedModel& base, FittedCandidate& candidate) const;
  /// Continues the fit with twice as many trials: the choice is among these.
  void continue_with_more_trials(const FittedModel& base, FittedCandidate& candidate) const;
  /// Goes on with the fit of the model that was chosen until a round gains nothing: an effect that changes much leaves
  /// the ground far from its optimum. Keeps the result where it is better.
  void complete(const FittedModel& base, FittedCandidate& chosen) const;
  /// The objective of a model on blocks that its fit has not seen, for each of some random orders of the blocks. An
  /// order is cut into folds; each fold is simulated with the minimum of the quadratic model of the other folds' rows.
  std::vector<Score> cross_validated(const FittedModel& fitted) const {
    const Timesheet::Phase phase(times_, "cross-validation");
    return cross_validated(fitted, Judges::Choice);
  }
  /// Runs of every block with a fold, simulated with the minimum of the quadratic model of the other folds' rows.
  ///
  /// @param fold_of  by block: below `folds`, else the block is left out
  std::vector<BlockRuns> out_of_fold(const FittedModel& fitted, std::span<const std::uint32_t> fold_of,
                                     std::size_t folds, ObserveOptions how) const;
  /// Simulates a candidate and its base once more, with new random numbers and more of them. A row is scored where the
  /// same share of the trials gives a value as in the choice: with a fixed number of values, rows that the choice left
  /// to the climatology would decide. @return its gains then
  Confirmation confirmation(const FittedModel& base, const FittedCandidate& candidate) const;
  /// The time sheet of these fits; whoever does other work of the diagnosis enters it here.
  Timesheet& times() const { return times_; }

 private:
  ObserveOptions observe_options(std::uint32_t trials) const;
  FitOptions fit_options() const;
  FitOptions continued_fit_options(const FittedModel& fitted) const;
  FittedModel fitted_model(Fit&& fit, std::vector<Parameter> free) const;
  FittedModel without_effect(const FittedModel& base, const Model& off, std::vector<Parameter> free,
                             Eigen::Index added) const;
  FittedModel continued(const FittedModel& fitted, FitOptions how) const;
  void continue_with(const FittedModel& base, FittedCandidate& candidate, const FitOptions& how) const;
  void take_fit(FittedModel&& fitted, FittedCandidate& candidate) const;
  void measure_gain(const FittedModel& base, FittedCandidate& candidate) const;
  /// The place from which the fit of a candidate starts.
  struct Start {
    Evaluation best;
    bool hopeless = false;  ///< even the smallest amount makes the objective much worse
  };
  Start best_start(const FitProblem& problem, const FitOptions& how, const FittedModel& base,
                   const Candidate& candidate, const Verdict& verdict) const;
  std::vector<Score> cross_validated(const FittedModel& fitted, Judges judges) const;

  const Campaign& campaign_;
  const DiagnoseOptions& options_;
  const std::vector<bool>& rows_;
  std::function<bool(double)> proceed_;
  std::uint32_t round_ = 0;
  mutable Timesheet times_;
};

}  // namespace talus
