#pragma once
#include <limits>
#include <map>

#include "talus/fit/diagnose/candidate.hpp"
#include "talus/fit/diagnose/dispersion.hpp"
#include "talus/fit/diagnose/verdict.hpp"

namespace talus {

/// How well a campaign measures a parameter of an effect at one of its places.
struct Precision {
  std::vector<std::size_t> members;                                 ///< indices into the candidates
  std::size_t parameter = 0;                                        ///< of the candidate
  double standard_error = std::numeric_limits<double>::infinity();  ///< in units of what one would notice
};

/// Result of the test for an effect, at the best of its places.
struct EffectVerdict {
  std::string effect;
  Verdict best;
  Verdict second;                                  ///< the next best place; without members where there is no other
  double p_value = 1.0;                            ///< corrected for the number of its places, from simulated data sets
  std::vector<double> drawn;                       ///< by simulated data set: the smallest p-value over its places
  std::map<std::string, Precision> sharpest = {};  ///< by key of the parameter: of the place that measures it best
  std::vector<Precision> places = {};              ///< of each candidate's own place; both follow from the model alone
};

struct ScoreTest {
  std::vector<EffectVerdict> effects;  ///< most significant first
  double p_value = 1.0;                ///< of the most significant one, corrected for all effects and places
  DispersionTest dispersion;           ///< by the same simulated data sets
};

struct ScoreTestOptions {
  std::uint32_t trials = 200;
  std::uint64_t seed = 1;
  int threads = 0;
  int replicates = 2000;             ///< simulated data sets without an effect
  DiagnosisRules rules;              ///< its candidates, residual and steps
  std::function<bool()> proceed;     ///< called now and then, by one thread; false ends the test. May be empty
  TracedVertices* traced = nullptr;  ///< as in ObserveOptions
};

/// The model that is tested. The parts must outlive it.
struct TestedModel {
  const Model& model;
  std::span<const Parameter> free;     ///< its fitted parameters
  const Eigen::VectorXd& z;            ///< of them
  const std::vector<BlockRuns>& runs;  ///< of the asked blocks, with random numbers that the search has not used
};

/// Runs of a model, with the same random numbers for every model.
using Observer = std::function<std::vector<BlockRuns>(const Model&)>;

/// A fitted model with its free parameters moved to where the score test is made.
struct SettledModel {
  Model model;
  Eigen::VectorXd z;             ///< of the free parameters
  std::vector<BlockRuns> runs;   ///< as TestedModel::runs
  double statistic = kNotGiven;  ///< of the scores of the free parameters here; its mean in a right model: their number
  double statistic_of_fit = kNotGiven;  ///< the same of the fitted model

  TestedModel tested(std::span<const Parameter> free) const { return {model, free, z, runs}; }
};

/// Moves the free parameters of a fitted model (ground, and effects found so far) in Newton steps, until the residual
/// that the score test takes has little left that they could explain, each halved where it does not help; of the places
/// on the way the one with the smallest statistic. A fit ends elsewhere: its objective is another one, and its prior
/// holds it back. The signatures are those of small changes, so that what a large one would explain is left over at the
/// fit and taken for an effect.
///
/// @param simulated  makes the runs of a moved model as TestedModel::runs were made
/// Throws FitInterrupted when `options.proceed` returns false. Source: docs/diagnosis-method.md, "The score test".
SettledModel settled_model(const Campaign& campaign, const TestedModel& fitted, const std::vector<bool>& rows,
                           const ScoreTestOptions& options, const Observer& simulated);

/// Tests every candidate against the residual of a model, with the model's own parameters free to move along.
///
/// The residual of each block is compared with the one that a small amount of the candidate would leave (simulated: its
/// signature). The part that a change of the model's free parameters could imitate is taken out. The same is done with
/// data sets without an effect, which gives the p-values: one trial per block, of a ground that the measurements leave
/// open, stands in for the measurement.
///
/// @param rows  the blocks that are used; size: blocks
///
/// Throws FitInterrupted when `proceed` returns false.
ScoreTest score_test(const Campaign& campaign, const TestedModel& base, std::span<const Candidate> candidates,
                     const std::vector<bool>& rows, const ScoreTestOptions& options);

/// A score test, and the model at which it was made.
struct SettledTest {
  SettledModel model;
  ScoreTest test;  ///< its Verdict::ground are changes of the fitted model
};

/// `score_test` of a fitted model, at its `settled_model`.
SettledTest settled_test(const Campaign& campaign, const TestedModel& fitted, std::span<const Candidate> candidates,
                         const std::vector<bool>& rows, const ScoreTestOptions& options, const Observer& simulated);

}  // namespace talus
