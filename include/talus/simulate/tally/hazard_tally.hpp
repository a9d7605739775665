#pragma once
#include <span>
#include <vector>

#include "talus/base/scratch.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/simulate/tally/bytes.hpp"
#include "talus/simulate/tally/energy_bins.hpp"
#include "talus/simulate/tally/wide_sum.hpp"

namespace talus {

/// Energy bins and weight scale of the hazard, the same for all cells of a run.
struct HazardRules {
  EnergyBins bins;
  WeightScale scale;
  bool with_rotation = false;  ///< energies count the rotation; else they are translational

  std::size_t levels() const { return 1 + bins.thresholds().size(); }  ///< passage, then each threshold
};

/// Sums over the passages of a cell, each weighted by its annual frequency w: of its length L in plan, of L D with the
/// diameter D of the block, and of w L. Sums of parts of paths: they add up over cells, whatever the size of the cells.
///
/// A weight has less than 2^62 / room units (WeightScale), so that the weights of `room` rounds can be added. The units
/// of the sums below are divided by `room`: weight times length keeps as many bits in a run of many rounds as in one.
/// No passage of a cell is longer than 2 km, so it has less than 2^63 units, and 128 bits hold 2^64 passages.
struct WeightedLengths {
  static constexpr double kLengthUnit = 0x1p10;    ///< [m]
  static constexpr double kDiameterUnit = 0x1p16;  ///< [m^2]: 2 km of a block of 50 m

  WideSum length;       ///< [WeightScale::unit * kLengthUnit / WeightScale::room]
  WideSum by_diameter;  ///< [WeightScale::unit * kDiameterUnit / WeightScale::room]
  WideSum squares;      ///< [square_unit * kLengthUnit / WeightScale::room]
  bool operator==(const WeightedLengths&) const = default;
};

/// Annual frequency by energy in one place: each trajectory adds its weight once, in the bin of its largest energy
/// there.
///
/// Whole numbers only: equal bits in any order. Only the bins from the smallest to the largest energy are stored, 16
/// bytes each. docs/hazard.md, "What a run keeps".
class HazardCell {
 public:
  struct Bin {
    std::int64_t weight = 0;  ///< sum [WeightScale::unit]
    std::int64_t square = 0;  ///< sum of the squares of the weights, each rounded up [square_unit]
    bool operator==(const Bin&) const = default;
  };

  HazardCell() = default;
  explicit HazardCell(MemoryPolicy memory) : bins_(memory), overlaps_(memory), lengths_(memory) {}

  /// Adds trajectories in the order of their blocks; all trajectories of a stratum must come in one call.
  ///
  /// @param energies  largest energy of each trajectory here [kJ]
  /// @param annual_shares  one per trajectory; may be longer than `energies`
  void add(const HazardRules& rules, std::span<const float> energies, std::span<const AnnualShare> annual_shares);
  /// Adds a passage of a block: its lengths by level [m], the annual share of the block and its diameter [m].
  void add_lengths(const HazardRules& rules, std::span<const float> lengths, const AnnualShare& annual_share,
                   double diameter);
  void merge(const HazardCell& other);

  int first() const { return first_; }  ///< bin of bins()[0]
  std::span<const Bin> bins() const { return bins_; }

  /// By level, the excess of the variance that independent trajectories would have. The true variance is smaller,
  /// because the number of blocks of a stratum is fixed. Sum over the strata of ((sum w)^2 - sum w^2) / (blocks - 1)
  /// [square_unit].
  std::span<const std::int64_t> overlaps() const { return overlaps_; }

  /// By level: passage, then each threshold; empty if none was counted.
  std::span<const WeightedLengths> lengths() const { return lengths_; }

  /// A cell with these contents.
  static HazardCell restored(int first, const std::vector<Bin>& bins, const std::vector<std::int64_t>& overlaps,
                             const std::vector<WeightedLengths>& lengths);

  void save(ByteWriter& out) const;
  /// Reads what `save` wrote. Throws std::out_of_range if the bytes cannot be of a cell with these rules.
  static HazardCell restored(const HazardRules& rules, ByteReader& in);

  bool operator==(const HazardCell& other) const;  ///< of the contents; reserved memory does not count

 private:
  void cover(int low, int high);

  int first_ = 0;
  ScratchVector<Bin> bins_;
  ScratchVector<std::int64_t> overlaps_;
  ScratchVector<WeightedLengths> lengths_;
};

/// The hazard of a cell at its place in a row.
struct HazardAt {
  int column;
  HazardCell cell;
  bool exit;  ///< paths leave the terrain from here
};

/// Sums the weights of one stratum in one place, by level: its share of `HazardCell::overlaps`.
class StratumSums {
 public:
  explicit StratumSums(const HazardRules& rules) : rules_(rules), levels_(rules.levels()) {}

  /// Adds a trajectory. If it begins a new stratum, first adds the finished stratum to `overlaps`.
  void add(const AnnualShare& annual_share, float energy, ScratchVector<std::int64_t>& overlaps);
  void finish(ScratchVector<std::int64_t>& overlaps);

 private:
  struct Level {
    std::int64_t sum = 0;
    double squares = 0.0;
    std::uint32_t hits = 0;
  };
  const HazardRules& rules_;
  std::vector<Level> levels_;
  std::uint64_t stratum_ = 0;
  std::uint32_t blocks_ = 0;  // 0: no stratum yet
};

}  // namespace talus
