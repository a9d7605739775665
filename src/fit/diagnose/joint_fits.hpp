#pragma once
#include "effect_fits.hpp"
#include "talus/fit/diagnose/several_sites.hpp"

namespace talus {

/// A candidate of one site, nothing where the site cannot have it (block-shape among spheres).
using SiteCandidates = std::vector<std::optional<Candidate>>;

/// The fits of several campaigns together, as `EffectFits` makes those of one.
class JointFits {
 public:
  JointFits(std::span<const Site> sites, const DiagnoseOptions& options, std::function<bool(double)> proceed);

  const std::vector<std::vector<bool>>& rows() const { return rows_; }
  const std::vector<std::uint32_t>& streams() const { return streams_; }
  /// Number of fitting blocks of all sites.
  std::size_t blocks() const;

  /// The grounds of all sites as their own fits have left them, then fitted on together for as long as an effect will
  /// be.
  JointModel fit_ground(std::span<const SiteDiagnosis> sites) const;
  /// Begins a round with random numbers that no earlier one has used. @return the base, simulated anew
  JointModel begin_round(JointModel base);
  /// The least objective over some amounts of an effect.
  ///
  /// @param estimates  amounts from which the search starts, in units of what one would notice
  Evaluation best_start(const JointModel& base, const SiteCandidates& candidate,
                        std::span<const Eigen::VectorXd> estimates) const;
  /// The effect with the grounds, from the best start on.
  JointCandidate fit_effect(const JointModel& base, const SiteCandidates& candidate,
                            const Eigen::VectorXd& start) const;
  /// Fits the chosen model on, from a search around where it is, until a round gains nothing.
  void complete(const JointModel& base, JointCandidate& chosen) const;
  /// Objectives over the blocks of all sites, each simulated by a fit to the other folds; one for each order of the
  /// blocks.
  std::vector<Score> cross_validated(const JointModel& fitted, Judges judges) const;
  /// As EffectFits::confirmation.
  Confirmation confirmation(const JointModel& base, const JointCandidate& candidate) const;

 private:
  FitProblem problem_of(const JointParameters& parameters, const std::vector<Model>& start) const;
  FitOptions fit_options() const;
  std::uint32_t first_trial() const;
  JointModel fitted(const FitProblem& problem, const JointParameters& parameters, const FitOptions& how) const;
  JointModel continued(JointModel fitted, int rounds, std::uint32_t times_trials) const;
  void take_fit(const JointModel& base, JointModel&& fitted, JointCandidate& candidate) const;
  JointModel simulated_anew(JointModel fitted) const;
  std::vector<std::vector<BlockRuns>> observe_all(const std::vector<Model>& models, std::uint32_t trials,
                                                  std::uint32_t first) const;

  std::span<const Site> sites_;
  const DiagnoseOptions& options_;
  std::function<bool(double)> proceed_;
  std::vector<std::vector<bool>> rows_;  // by site
  std::vector<std::uint32_t> streams_;   // of all blocks
  std::uint32_t round_ = 1;              // the sites' own fits had the first
};

}  // namespace talus
