#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "talus/fit/campaign/observe.hpp"

/// Nested cross-validation of a diagnosis. docs/diagnosis-evidence.md, "Every block is used".
namespace talus {

/// Fold of a block that has none: it is held out of all.
inline constexpr std::uint32_t kNoFold = 0xFFFFFFFF;

/// Parts into which the fitting blocks are cut. Each is left out once.
struct OuterFolds {
  std::size_t count = 0;
  bool by_group = false;               ///< whole groups are left out; false: blocks
  std::vector<std::uint32_t> fold_of;  ///< by block: below `count`, or kNoFold
  bool splits_groups = false;          ///< blocks of one group are in several folds
};

/// Cuts by `group` where every block has one, there are at least as many groups as folds, and none holds more than half
/// of the blocks; else by block. The order in which groups or blocks are dealt out follows from their random streams,
/// never from a file.
OuterFolds outer_folds(const Campaign& campaign, const std::vector<bool>& rows, std::size_t folds, std::uint64_t seed);

/// The campaign as it would be if a fold had not been measured: its blocks are held out, and their measurements are
/// gone; so are those of blocks without a fold.
Campaign without_fold(const Campaign& campaign, const OuterFolds& folds, std::uint32_t fold);

/// The diagnosis without one fold.
struct OuterFold {
  std::size_t blocks = 0;           ///< left out
  std::vector<std::string> groups;  ///< left out, if folds are groups
  std::vector<std::string> effects, where;
  double p_value = kNotGiven;  ///< of the first round; NaN where the fold did not choose
};

/// Every fitting block simulated with models that have not seen it (folds that do not choose: whose place, design and
/// neighbourhood are those of all rows).
struct NestedValidation {
  OuterFolds folds;
  bool naming = true;  ///< the folds chose their effects; false: they took those that all rows chose
  std::vector<OuterFold> loops;
  std::uint32_t trials = 0;
  std::vector<BlockRuns> base, found;  ///< by block, with the same random numbers: the ground alone, and what was found

  /// The candidates of the first round of all rows. Their places and designs are those of all rows; the numbers of each
  /// fold are the optimum of the quadratic model of the other rows.
  std::vector<BlockRuns> ground;
  /// The ground of all rows, which has seen the fold: what candidates are compared with that were fitted to it (ground
  /// held). Empty where there are none.
  std::vector<BlockRuns> held;
  std::vector<std::vector<BlockRuns>> candidates;  ///< as DiagnosisRound::candidates; empty: not fitted
};

}  // namespace talus
