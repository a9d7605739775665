#pragma once
#include <optional>
#include <string_view>

#include "talus/fit/calibrate/fit_problem.hpp"
#include "talus/fit/diagnose/detection_limit.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"
#include "talus/fit/diagnose/family_test.hpp"
#include "talus/fit/diagnose/nested.hpp"
#include "talus/fit/diagnose/residual_table.hpp"
#include "talus/fit/diagnose/stability.hpp"
#include "talus/fit/diagnose/timesheet.hpp"
#include "talus/fit/score/bootstrap.hpp"

namespace talus {

/// A model that has been fitted, with its free parameters.
struct FittedModel {
  Model model;
  std::vector<Parameter> free;
  Eigen::VectorXd z;                    ///< of the free parameters
  std::vector<BlockRuns> runs;          ///< of the fitting rows, with random numbers that the search has not used
  Score score;                          ///< of the runs
  Score objective;                      ///< the same with its groups weighed; effects are chosen by it
  Eigen::MatrixXd spread;               ///< covariance of z within which the objective is nearly as good
  std::vector<Evaluation> evaluations;  ///< of this fit and those before it; the next fit uses them
};

/// Gains of a candidate that may be chosen, with random numbers that no choice has used: those of the best of several
/// are partly chance. NaN: not asked for.
struct Confirmation {
  double fitted = kNotGiven;  ///< of the objective of the fitting rows
  double unseen = kNotGiven;  ///< in cross-validation, less the price of its place
};

/// An effect at its best place, as its fit has left it: what the choice among the effects of a round rests on.
struct FittedEffect {
  std::string effect, where;
  std::vector<Parameter> parameters;   ///< of the effect itself
  std::size_t tested = 0;              ///< number of them that the score test moves; all at zero: no effect
  std::vector<double> values;          ///< fitted values of the parameters
  double gain = 0.0;                   ///< decrease of the objective of the fitting rows, without the prior
  Interval gain_interval;              ///< 95 %, paired bootstrap over blocks
  double price = 0.0;                  ///< gain that its fitted numbers and those of its place must bring
  double place_price = 0.0;            ///< the part of the price for its place, which was chosen by all blocks
  double cross_validated = kNotGiven;  ///< gain on blocks that its fit has not seen; NaN: not cross-validated
  Interval cross_validated_interval;   ///< 95 %, paired bootstrap over blocks
  Confirmation confirmation;
  double amount = 0.0;        ///< largest of its tested parameters, in units of what one would notice
  double chosen_share = 0.0;  ///< share of the bootstraps in which it has the lowest objective of all

  double net_gain() const { return gain - price; }
  /// Gain on blocks that its fit has not seen, less the price of its place. NaN: not cross-validated.
  double unseen_gain() const { return cross_validated - place_price; }
  Interval unseen_gain_interval() const {
    return {cross_validated_interval.low - place_price, cross_validated_interval.high - place_price};
  }
};

/// An effect fitted together with the parameters of the base, to one campaign.
struct FittedCandidate : FittedEffect {
  bool with_ground = true;  ///< false: the ground was held, because it may not be chosen
  bool refined = true;      ///< false: no amount helped, so that it was not fitted: its numbers are off
  double p_value = 1.0;     ///< of the score test, corrected for the places of the effect
  std::string family;       ///< by which it may be chosen; empty: it may not
  double statistic = 0.0;   ///< of the score test
  FittedModel fitted;
};

/// Whether the verdict of a round is an effect, and neither "none" nor "unexplained".
inline bool names_effect(std::string_view verdict) {
  return verdict != "none" && verdict != "unexplained";
}

/// How the free parameters of a fit moved to where the score test was made: `SettledModel`.
struct Settling {
  std::size_t parameters = 0;
  double statistic_of_fit = kNotGiven, statistic = kNotGiven;  ///< of their own scores, before and after
  double farthest = kNotGiven;                                 ///< move of the one that moved most [z]
};

/// One turn of the loop.
struct DiagnosisRound {
  std::string effect = "none";  ///< the one that was found, "none" or "unexplained"
  std::string where;
  bool tried = true;                        ///< false: a family is significant, but no further effect was allowed
  std::vector<FittedCandidate> candidates;  ///< every effect at its best place, best first
  std::vector<std::string> alike;           ///< effects that these data cannot tell apart from it
  std::vector<ResidualRow> residual;        ///< of the fitting rows, before the effect is added
  std::vector<FamilyTest> families;         ///< all, in a fixed order
  double p_value = 1.0;                     ///< the smallest of the families' corrected ones
  Settling settling;                        ///< before the tests of place and instrument
  std::vector<DetectionLimit> limits;       ///< of the effects that the base lacks
};

/// Trajectories of each block.
struct TrialsPerBlock {
  std::uint32_t search = 24, test = 100, compare = 200;
};

struct Diagnosis {
  FittedModel base;                    ///< the ground alone, simulated with the random numbers of `with_effects`
  std::vector<DiagnosisRound> rounds;  ///< the last one found "none" or "unexplained"
  FittedModel with_effects;            ///< the last model; the base if nothing was found
  TrialsPerBlock trials;               ///< numbers that were simulated
  Timesheet times;                     ///< where the processor time went
  std::uint64_t vertices = 0;          ///< traced by the loop over all fitting rows
  bool ended_early = false;            ///< the last round fitted no effects, as those before were costly
  Stability stability;                 ///< the verdicts of independent base fits, this one's among them
  std::optional<NestedValidation> nested;
};

struct DiagnoseOptions {
  std::vector<std::string> keys{"theta_scale", "psi_scale", "En50", "Et50"};  ///< of the ground, fitted per zone
  TrialsPerBlock trials;                                                      ///< of 72 blocks; of fewer, more
  std::uint64_t seed = 1;
  int threads = 0;
  /// Effects added, one a round. Not given: three, but none after the first where `DiagnosisRules::enough` is reached.
  std::optional<int> most_effects;
  int effects_at_most() const { return most_effects.value_or(3); }
  double first_level = 0.05;  ///< over all families: the false alarms that are accepted
  double later_level = 0.01;  ///< after the first effect: its form is a guess, which leaves a residual
  /// @param round  from 0
  double level_of_round(std::size_t round) const { return round == 0 ? first_level : later_level; }
  /// Data sets that are drawn from the model to test some families: 2000, and so many that the rarest of all is
  /// significant after the correction for the families, by a fifth of the first level and by the later one.
  int replicates(std::size_t families) const;
  /// Fits of the ground whose verdicts are compared; 1: this diagnosis alone. Not given: five, or as many of them as
  /// `DiagnosisRules::enough` allows.
  std::optional<int> base_fits;
  int base_fits_at_most() const { return base_fits.value_or(5); }
  bool nested = false;  ///< also repeats the loop without each outer fold
  std::size_t outer_folds = 5;
  /// Whether the loop is repeated without each fold. False: a fold takes the effects that all rows chose, and its
  /// numbers are the optimum of the quadratic model of the other rows. Not given: `DiagnosisRules::costly` decides.
  std::optional<bool> naming_in_folds;
  DiagnosisRules rules;                 ///< numbers that no user sets
  std::function<bool(double)> proceed;  ///< receives the share done, 0..1; false ends the diagnosis. May be empty
  TracedVertices* traced = nullptr;     ///< set by the loop, for its fits
};

}  // namespace talus
