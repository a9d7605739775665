#pragma once
#include "talus/fit/diagnose/residual.hpp"

namespace talus {

/// How much a kind of quantity scatters about the mean of its group, against the model.
struct DispersionRow {
  std::string what;        ///< "runout", "lateral", "speed", ..., "runout beyond P95"
  double statistic = 1.0;  ///< variance of z within groups; of a tail the share of the blocks (0.05 if all is right)
  double p_value = 1.0;    ///< among data sets without an effect; of a variance two-sided, of a tail one-sided
};

/// Test whether the model scatters too much or too little, or has too short a tail.
struct DispersionTest {
  std::vector<DispersionRow> rows;  ///< in the order of the observables, the tail last
  double p_value = 1.0;             ///< of the rarest row, corrected for their number
  bool tested = false;              ///< false: too few blocks, or no data sets
};

/// The scatter of a data set, by kind of quantity: the mean square of the places z less their mean over the blocks of
/// a group, so that neither a group that is off as a whole nor a mean that is off counts; then the share of the
/// run-outs beyond P95, of z itself.
class Scatters {
 public:
  /// @param blocks    that are used
  /// @param measured  residuals of these blocks, components x blocks: kinds of which too few were measured are left out
  Scatters(const Campaign& campaign, const ResidualSpace& space, const std::vector<std::size_t>& blocks,
           const Eigen::MatrixXd& measured);

  /// @param residuals  components x blocks. @return by kind: the variance, of a tail the share; 1 and 0 where nothing
  /// of a kind was seen
  Eigen::VectorXd of(const Eigen::MatrixXd& residuals) const;

  /// A kind of quantity.
  struct Kind {
    std::string what;
    std::vector<Eigen::Index> observables;  ///< that it sums up
    bool tail = false;
  };
  const std::vector<Kind>& kinds() const { return kinds_; }

 private:
  std::vector<Kind> kinds_;
  std::vector<std::size_t> groups_;  // by block
};

/// Compares the measured scatter with that of data sets without an effect.
///
/// @param drawn     kinds x sets
/// @param measured  by kind
DispersionTest dispersion_test(const std::vector<Scatters::Kind>& kinds, const Eigen::MatrixXd& drawn,
                               const Eigen::VectorXd& measured);

}  // namespace talus
