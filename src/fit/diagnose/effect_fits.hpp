#pragma once
#include "talus/fit/diagnose/diagnose.hpp"

namespace talus {

class LocalModel;

/// By how much an effect must lower the objective to be named.
struct Worth {
  double fitted;  ///< of the fitting rows
  double unseen;  ///< in cross-validation
};

/// The fits of one diagnosis: of the ground, and of each effect on top of what has been found before.
///
/// What one fit has simulated is kept, and the next one learns from it too: an effect is added to a ground whose
/// neighbourhood is known. docs/closing-the-loop.md, "Diagnosis".
class EffectFits {
 public:
  /// @param proceed  asked now and then, told which share of the fit is done; false: FitInterrupted is thrown
  EffectFits(const Campaign& campaign, const DiagnoseOptions& options, const std::vector<bool>& rows,
             std::function<bool(double)> proceed)
      : campaign_(campaign), options_(options), rows_(rows), proceed_(std::move(proceed)) {}

  /// Begins a round: all that is compared in it has luck that no earlier round has seen. @return the model to start
  /// from, simulated anew
  Fitted begin_round(Fitted base);
  /// A fit simulated on the luck of this round.
  Fitted again(Fitted fitted) const;
  /// The ground alone, as `calibrate` fits it, its fit gone on with where that is better: what it has missed looks
  /// like an effect.
  Fitted ground(const Model& start) const;
  /// An effect at its best place, from what the score test expects of it; with the ground where the test finds anything
  /// in it.
  Trial effect(const Fitted& base, const EffectVerdict& verdict, const Candidate& candidate) const;
  /// The least objective that a look at some amounts of an effect finds, to compare its places.
  double promise(const Fitted& base, const Verdict& verdict, const Candidate& candidate) const;
  /// Goes on with the fit of an effect that is among the best, where that makes it better.
  void go_on(const Fitted& base, Trial& trial) const;
  /// The same with more trials: between these is chosen, and the user gets one of them.
  void polish(const Fitted& base, Trial& trial) const;
  /// The objective of a model on blocks that its fit has not seen: five folds, each of them simulated with the model
  /// that is best for the others, which is the minimum of the quadratic model of their rows. Mean over five orders in
  /// which the blocks are cut.
  double cross_validated(const Fitted& fitted) const {
    ObserveOptions unseen = observing(options_.trials.compare);
    unseen.first_trial += options_.trials.compare;  // the first of them have chosen between fits
    return cross_validated(fitted, unseen);
  }
  /// Whether a trial gains so much on luck that nothing was chosen by, on its rows and in cross-validation: of several
  /// effects the best one was lucky, too.
  bool confirmed(const Fitted& base, const Trial& trial, const Worth& worth) const;
  /// The one with the lower objective; what the other has simulated is kept, too.
  static Fitted better(Fitted fitted, Fitted longer);

 private:
  ObserveOptions observing(std::uint32_t trials) const;
  FitOptions going_on(const Fitted& fitted) const;
  double cross_validated(const Fitted& fitted, ObserveOptions how) const;
  FitOptions fitting() const;
  Fitted finish(Fit&& fit, std::vector<Parameter> free) const;
  Fitted refined(const Fitted& fitted, FitOptions how) const;
  void compare(const Fitted& base, Trial& trial) const;  ///< what the fit of a trial gained
  void continued(const Fitted& base, Trial& trial, const FitOptions& how) const;
  static void adopt(Fitted&& fitted, Trial& trial);
  static Model without(const Fitted& base, const Candidate& candidate);
  Evaluation scan(const FitProblem& problem, const FitOptions& how, const Fitted& base, const Candidate& candidate,
                  const Verdict& verdict) const;
  std::vector<std::size_t> shuffled_rows(std::uint32_t number) const;
  double error_in_folds(const LocalModel& local, const Fitted& fitted, ObserveOptions how,
                        const std::vector<std::size_t>& order) const;

  const Campaign& campaign_;
  const DiagnoseOptions& options_;
  const std::vector<bool>& rows_;
  std::function<bool(double)> proceed_;
  std::uint32_t round_ = 0;
};

}  // namespace talus
