#pragma once
#include "talus/fit/diagnose/residual_table.hpp"
#include "talus/fit/diagnose/score_test.hpp"

namespace talus {

/// A model that has been fitted, with what is free in it.
struct Fitted {
  Model model;
  std::vector<Parameter> free;
  Eigen::VectorXd z;               ///< of the free parameters
  std::vector<BlockRuns> fitting;  ///< of the fitting rows, on luck that the search has not seen
  Score score;                     ///< of those
  Score objective;                 ///< the same, as the fit weighs it: what effects are chosen by
  Eigen::MatrixXd spread;          ///< covariance of z within which the objective is nearly as good
  std::vector<Evaluation> tried;   ///< by its fit and those before: what the next one learns from
};

/// A candidate fitted together with the base parameters.
struct Trial {
  std::string effect, where;
  std::vector<Parameter> parameters;  ///< its own
  std::size_t tested = 0;             ///< the first of them: zero of these is none of the effect
  std::vector<double> values;         ///< of them, fitted
  bool joint = true;                  ///< false: the ground was held, because the test found nothing
  double p_value = 1.0;               ///< of the score test, corrected for its places
  double statistic = 0.0;             ///< of the score test
  double gain = 0.0;         ///< by which it lowers the objective of the fitting rows: groups weighed, no prior
  Interval gain_interval;    ///< 95 %, paired bootstrap over blocks
  double price = 0.0;        ///< that its fitted numbers, those of its place too, must gain to be worth it
  double place_price = 0.0;  ///< that of its place alone, which was chosen by all blocks
  double cross_validated =
      kNotGiven;              ///< by which it lowers that of blocks its fit has not seen; NaN where it was not asked
  double amount = 0.0;        ///< of it, fitted, in units of what one would notice: the largest of those tested
  double chosen_share = 0.0;  ///< of the bootstraps in which it has the lowest objective of all
  Fitted fitted;

  /// What blocks gain that its fit has not seen, less the price of its place. NaN where it was not cross-validated.
  double unseen_gain() const { return cross_validated - place_price; }
};

/// One turn of the loop.
struct Round {
  std::string effect = "none";  ///< what was found; "none", "unexplained"
  std::string where;
  std::vector<Trial> trials;          ///< every effect at its best place, best first
  std::vector<std::string> alike;     ///< what cannot be told apart from it on these data
  std::vector<ResidualRow> residual;  ///< before, on the fitting rows
  double p_value = 1.0;               ///< that the residual is noise: score test over all effects and places
};

/// Trajectories of each block.
struct TrialsPerBlock {
  std::uint32_t search = 24, test = 100, compare = 200;
};

/// As many trajectories for a campaign of few blocks as for one of 72: what counts are means over blocks. At most four
/// times as many of each block.
///
/// @param blocks  that are fitted
TrialsPerBlock shared_out(TrialsPerBlock trials, std::size_t blocks);

struct Diagnosis {
  Fitted base;                ///< recalibrated, without an effect; simulated on the luck of `with_effects`
  std::vector<Round> rounds;  ///< the last one found "none" or "unexplained"
  Fitted with_effects;        ///< the last model; the base where nothing was found
  TrialsPerBlock trials;      ///< that were simulated
};

struct DiagnoseOptions {
  std::vector<std::string> keys{"theta_scale", "psi_scale", "En50", "Et50"};  ///< of the ground, fitted per zone
  TrialsPerBlock trials;                                                      ///< of 72 blocks; of fewer, more
  std::uint64_t seed = 1;
  int threads = 0;
  int most_effects = 3;
  double first_level = 0.05;            ///< of the score test, over all effects: the false alarms that are accepted
  double later_level = 0.01;            ///< once an effect is in: its form is itself a guess, which leaves a residual
  DiagnosisRules rules;                 ///< numbers that no user sets
  std::function<bool(double)> proceed;  ///< told the share done, 0..1; false ends it. May be empty
};

/// Finds what a model of the ground alone leaves of a campaign's fitting rows, and which effect explains it.
///
/// @param campaign  with at least one fitting block
///
/// (1) Fits the ground. (2) Score test of all candidates. (3) Fits every effect at its best place, together with the
/// ground where the test finds anything in it; the best of them for longer. (4) Chooses: significant in the test, the
/// lowest error in a cross-validation over blocks. (5) Puts it in and goes round again. The held-out rows are never
/// looked at. docs/closing-the-loop.md, "Diagnosis".
///
/// Throws FitInterrupted when `proceed` says no.
Diagnosis diagnose(const Campaign& campaign, const Model& start, const DiagnoseOptions& options);

}  // namespace talus
