#pragma once
#include <functional>

#include "talus/fit/diagnose/residual.hpp"

namespace talus {

/// Dependence of the residual of one observable on one property of the blocks.
struct ResidualRow {
  std::string observable;  ///< "runout", "speed S1", ...; `kLeaving`
  std::string covariate;   ///< "mean", "spread", "mass", "L1/L2", "L1/L3", "day", "release height", "east", "north";
                           ///< of `kLeaving` "number"
  double statistic;    ///< of "mean" the mean of z, less the expected one; of "spread" its variance over the expected
                       ///< one; of a crossing a standard normal number, positive where more cross than should; of
                       ///< "number" how many more leave than should, at most; else Spearman's rank correlation
                       ///< (ResidualSpace::rank_of_measured)
  double p_value;      ///< of this row alone, two-sided; of "number" one-sided
  double corrected;    ///< for the number of rows (Holm)
  std::size_t blocks;  ///< where rocks were released more than once, of their properties: rocks
};

/// Observable of the row with the number of blocks that leave the DEM (`leaving_test`).
inline constexpr const char* kLeaving = "leaving the DEM";

/// A property of the blocks on which a residual may depend.
struct Property {
  const char* name;                                ///< as in ResidualRow::covariate
  const char* unit;                                ///< empty: none
  std::function<double(const MeasuredBlock&)> of;  ///< NaN: not known of this block
  bool of_rock = false;                            ///< the same in each release of a rock
};
const std::vector<Property>& properties();

/// Every observable against every property, most significant first. Rows with fewer than ten blocks are left out. A
/// rock that was released more than once (docs/diagnosis-method.md, "Rocks") counts once against its mass and shape,
/// with the means of its releases, and there must be six rocks. Crossings are tested against these only where most
/// blocks are the only release of their rock. `kLeaving` has a row where five blocks leave by the model.
///
/// @param runs  of which `space` was made
std::vector<ResidualRow> residual_table(const Campaign& campaign, const ResidualSpace& space,
                                        const std::vector<BlockRuns>& runs, const std::vector<bool>& rows,
                                        const DiagnosisRules& rules);

/// Spearman's rank correlation of two lists of equal length; ties share their mean rank.
double spearman(std::span<const double> a, std::span<const double> b);

}  // namespace talus
