#pragma once
#include <optional>
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// The annual frequency that one trajectory stands for, and its stratum.
struct AnnualShare {
  std::int64_t weight = 0;    ///< events per year, in units of WeightScale::unit
  std::uint64_t stratum = 0;  ///< number of the stratum: some blocks of one source cell
  std::uint32_t blocks = 0;   ///< number of blocks in the stratum
};

/// Units and limits of the weights, the same for all trajectories of a run.
struct WeightScale {
  double unit = 0.0;               ///< [1/year], a power of two
  double square_unit = 0.0;        ///< of sums of squares [1/year^2], a power of two
  double total = 0.0;              ///< events per year of all trajectories
  std::int64_t largest = 0;        ///< weight of a trajectory [units]
  std::uint64_t trajectories = 0;  ///< number of trajectories
  bool equal = true;               ///< all have the same weight
  double largest_diameter = 0.0;   ///< of the blocks of the scenario [m]
  double room = 1.0;               ///< number of rounds that the units leave room for, a power of two

  double largest_weight() const { return static_cast<double>(largest) * unit; }  ///< [1/year]
  bool operator==(const WeightScale&) const = default;
};

/// Frequencies of the classes of blocks [1/year], or their shares where the scenario says so; empty if they have none.
/// Blocks drawn by a power law of volume are one class. Throws InputError if a power law does not hold for the blocks.
std::vector<double> class_frequencies(const Scenario& scenario);

/// The warnings that rest on the frequencies of a valid scenario: `rare_class_warning`, `retreat_warning`, and how many
/// cells several features release, unless each feature says how often its blocks fall. docs/hazard.md, "How often".
std::vector<std::string> frequency_warnings(const Scenario& scenario);

/// Whether a warning of a run is one of these: with another weighting they are others.
bool is_of_frequencies(const std::string& warning);

/// Events per year of every source cell and class of blocks, as whole multiples of a unit: sums over trajectories are
/// equal in any order. The unit is a power of two, chosen so that the sum over all trajectories of all rounds stays
/// below 2^62; it follows from the scenario and the number of rounds asked for, so that parts of one plan have the
/// same.
///
/// A source cell releases n blocks, and a class has the share p of them. A trajectory of the class stands for
/// (events per year of cell and class) / (n p). docs/hazard.md, "Weights".
class AnnualWeights {
 public:
  /// @param rounds  most rounds that are summed, >= 1: they take bits from the weights, ceil(log2(rounds))
  /// @return nothing if the scenario has no frequency, or 0 everywhere
  /// Throws InputError if frequencies contradict each other or are incomplete, or if one is so small beside the others
  /// that the unit would change it by more than 0.05 %.
  static std::optional<AnnualWeights> of(const Scenario& scenario, std::uint32_t rounds = 1);

  /// Weight of block `block` of a source cell [units].
  std::int64_t weight(const Scenario& scenario, std::uint32_t source, std::uint32_t block) const;

  /// Events per year that a block of a class stands for, of a source cell.
  /// @param block_class  index into Blocks::classes; any where the weights do not depend on the class
  double of_class(std::uint32_t source, std::size_t block_class) const;

  const WeightScale& scale() const { return scale_; }

 private:
  std::size_t classes_ = 1;
  std::vector<std::int64_t> weights_;  // by source cell and class
  WeightScale scale_;
};

}  // namespace talus
