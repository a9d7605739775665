#pragma once
#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

#include "talus/fit/campaign/observe.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"

namespace talus {

/// A quantity of a block that is compared: one number. docs/diagnosis-method.md, "The residual".
///
/// Lateral: distance of the stop [m] from the line through the release towards the mean simulated stop; to the left,
/// seen from the release, it is positive.
struct Observable {
  enum class Kind { Runout, Lateral, Mass, Crossed, Speed, Jump, Spin, SampleSpeed, SampleSpin } kind;
  std::size_t screen = 0;  ///< of Crossed, Speed, Jump, Spin
  bool late = false;       ///< of the samples: the farther half of a block's
  std::string name;        ///< "runout", "speed S1", "sample spin late", ...
};

/// A block's residual: about standard normal numbers if the model is right; where simulated values are equal, their
/// variance is smaller (`ResidualSpace::moments`).
///
/// Per observable its place, z = Phi^-1(rank of the measured value among the simulated ones), and its spread,
/// (z^2 - 1) / sqrt(2); for a crossing (c - p) / sqrt(p (1 - p)). NaN where nothing was measured.
using Residual = Eigen::VectorXd;

/// The distributions that a model gives for every block of a campaign, and residuals against them.
class ResidualSpace {
 public:
  /// @param runs  of the model; at least 20 trials of each fitting block. The campaign must outlive this.
  ResidualSpace(const Campaign& campaign, const std::vector<BlockRuns>& runs, const DiagnosisRules& rules);

  const std::vector<Observable>& observables() const { return observables_; }
  const DiagnosisRules& rules() const { return rules_; }
  /// Moments of z of an observable of a block in a right model.
  struct Moments {
    double mean = 0.0, variance = 1.0, fourth = 3.0;  ///< the variance and the fourth moment about the mean
  };
  /// If all simulated values differ, these are the moments of a standard normal number. If some are equal (jumps of 0),
  /// each simulated value is ranked among the others, and the moments are those of the resulting z.
  Moments moments(std::size_t block, std::size_t observable) const;
  /// Number of components of a residual: places first, then spreads.
  Eigen::Index size() const { return 2 * static_cast<Eigen::Index>(observables_.size()); }

  /// Simulated share of a block's trials that cross the screen of an observable: in (0, 1).
  double crossing_share(std::size_t block, std::size_t observable) const {
    return crossing_share_[block * observables_.size() + observable];
  }

  Residual of_measured(std::size_t block) const;
  /// Rank of a measured value among the simulated ones, in (0, 1); between equal ones at a random place, the same in
  /// every call. In a right model it is uniform for every block, also where many simulated values are equal: blocks can
  /// be compared by it. Not of a crossing. NaN as z.
  double rank_of_measured(std::size_t block, std::size_t observable) const;
  /// Residual of a trial of other runs, as if it had been measured. Values that were not measured of the block are
  /// missing.
  Residual of_trial(std::size_t block, const BlockRuns& runs, std::size_t trial) const;
  /// The same of a trial of the runs that this was made of: it is ranked among the others. Ranked among all, itself
  /// included, it would lie nearer to the middle than a measured one, and right models would seem to scatter too
  /// little.
  Residual of_own_trial(std::size_t block, const BlockRuns& runs, std::size_t trial) const;

  /// `residual` divided by the correlation of its components, pooled over all blocks. Components that are NaN are left
  /// out and become zero.
  Eigen::VectorXd whitened(const Residual& residual) const;

 private:
  /// Simulated values that were observed, ascending; fewer than ten are not used.
  using Sorted = std::vector<double>;
  /// Measurements of one block, or of one of its trials. NaN: not seen.
  struct Seen {
    Eigen::Vector2d way{kNotGiven, kNotGiven};  // from the place of release to the stop [m]
    bool gone = false;                          // left the terrain, which is farther than any stop
    double mass_share = kNotGiven;
    std::vector<std::optional<Passage>> passages;   // by screen; nothing: not crossed
    std::vector<double> sample_speed, sample_spin;  // by sample
  };

  Seen seen_measured(std::size_t block) const;
  Seen seen_of_trial(std::size_t block, const BlockRuns& runs, std::size_t trial) const;
  /// @param own  here and below: whether the values are those of one of the simulated trials
  std::vector<double> values_of(std::size_t block, const Seen& seen, bool own) const;
  Residual residual(std::size_t block, const std::vector<double>& values, bool own) const;
  double sample_score(std::size_t block, const Observable& o, const std::vector<double>& values, bool own) const;
  void correlate(const std::vector<BlockRuns>& runs);

  const Campaign& campaign_;
  DiagnosisRules rules_;
  bool left_are_farther_;  // all fitting blocks came to rest: a trial that left went farther (`all_at_rest`)
  std::vector<Observable> observables_;
  std::vector<Eigen::Vector2d> forward_;                     // by block: towards its mean simulated stop, unit
  std::vector<std::vector<Sorted>> distributions_;           // by block and observable
  std::vector<std::vector<std::array<Sorted, 2>>> samples_;  // by block and sample: speed, spin
  std::vector<double> crossing_share_;                       // by block and observable
  Eigen::MatrixXd correlation_;
  mutable std::map<std::vector<bool>, Eigen::MatrixXd> inverses_;  // by the set of observed components
};

/// Quantile of the standard normal distribution; share in (0, 1). Source: boost::math.
double normal_quantile(double share);

}  // namespace talus
