#pragma once
#include "talus/fit/diagnose/residual.hpp"

namespace talus {

/// How much a kind of quantity scatters about the mean of its group, against the model.
struct DispersionRow {
  std::string what;        ///< "runout", "lateral", "speed", ..., "runout beyond P95"
  double statistic = 1.0;  ///< variance of z within groups; of a tail the share of the blocks (0.05 if all is right)
  double expected = 1.0;   ///< mean of the same over data sets drawn from the model
  double p_value = 1.0;    ///< among those data sets; of a variance two-sided, of a tail one-sided
};

/// Test whether the model scatters too much or too little, or has too short a tail.
struct DispersionTest {
  std::vector<DispersionRow> rows;  ///< in the order of the observables, the tail last
  double p_value = 1.0;             ///< of the rarest row, corrected for their number
  bool tested = false;              ///< false: too few blocks
};

/// The places z of a quantity of a block less their mean over the blocks of its group, so that neither a group that is
/// off as a whole nor a mean that is off counts as scatter. Their mean square is compared with that of data sets drawn
/// from the model: one trial of each block stands in for what was measured. The share beyond P95 is that of z itself.
///
/// @param runs  of which `space` was made
/// @param rows  the blocks that are used
DispersionTest dispersion_test(const Campaign& campaign, const ResidualSpace& space, const std::vector<BlockRuns>& runs,
                               const std::vector<bool>& rows, int replicates, std::uint64_t seed);

}  // namespace talus
