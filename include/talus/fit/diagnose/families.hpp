#pragma once
#include "talus/fit/diagnose/family_test.hpp"
#include "talus/fit/diagnose/property_test.hpp"
#include "talus/fit/diagnose/residual.hpp"
#include "talus/fit/diagnose/score_test.hpp"

namespace talus {

/// Number of families of a campaign.
inline constexpr std::size_t kFamilies = 5;

/// What the tests of families need of a fitted model.
struct FamilyInput {
  const Campaign& campaign;
  const ResidualSpace& space;
  const std::vector<BlockRuns>& runs;    ///< of which `space` was made
  const std::vector<bool>& rows;         ///< the blocks that are used
  const ScoreTest& score_test;           ///< where the same model has settled
  std::span<const std::string> found{};  ///< effects that the model has, which are no candidates any more
};

struct FamilyOptions {
  int replicates = 2000;  ///< simulated data sets; so many arrangements of a permutation test, at least
  std::uint64_t seed = 1;
  DiagnosisRules rules;
  double level = 0.05;  ///< at which a family is significant
};

/// Tests of all `kFamilies` families, in a fixed order, with Holm's correction.
std::vector<FamilyTest> test_families(const FamilyInput& input, const FamilyOptions& options);

/// The energy component of each asked block (`EnergyComponent`), the number in which a property of the block shows; NaN
/// of the others.
std::vector<double> energy_by_block(const ResidualSpace& space, const std::vector<BlockRuns>& runs,
                                    const std::vector<bool>& rows);

/// The family "block property" alone, of one campaign or of several together. Not corrected.
FamilyTest test_block_property(std::span<const BlockNumbers> sites, const FamilyOptions& options);

/// Holm's correction over some families; those that can name nothing take no part.
void correct(std::span<FamilyTest* const> families);

/// Name of the family to which an effect belongs.
std::string family_of(const std::string& effect);

/// Whether one of the families could name an effect, were it strong enough: the data can test it, and it may name.
bool can_be_named(std::span<const FamilyTest> families, const std::string& effect);

/// The smallest corrected p-value; 1 where no family was tested.
double smallest_corrected(std::span<const FamilyTest> families);

/// The family, significant at `level`, by which an effect may be chosen; nullptr: none.
const FamilyTest* admitting(std::span<const FamilyTest> families, const std::string& effect, double level);

}  // namespace talus
