#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "talus/simulate/plan/region.hpp"
#include "talus/simulate/tally/cell_record.hpp"
#include "talus/simulate/tally/hazard_tally.hpp"
#include "talus/simulate/tally/source_reach.hpp"
#include "talus/simulate/tally/visits.hpp"

namespace talus {

/// Sums over trajectories, per cell. The memory grows with the number of touched cells only.
///
/// The grid is cut into regions of 64 x 64 cells. A region is allocated when it is first touched, and a record in it
/// when its cell is. All workers share one tally: each locks the region it scores.
class Tally {
 public:
  /// @param memory  where the records are stored
  Tally(const Grid& grid, std::vector<double> energy_thresholds, std::vector<double> height_thresholds,
        MemoryPolicy memory = {});
  ~Tally();
  Tally(Tally&&) noexcept;

  /// Counts annual frequencies by energy too; call it before the first batch. Trajectories must then have annual
  /// shares.
  void keep_hazard(AnnualWeights weights);
  /// Keeps the energy with rotation per cell, too; call it before the first batch. Batches must then keep it.
  void keep_energy_total() { keep_total_ = true; }
  bool keeps_energy_total() const { return keep_total_; }
  /// Counts exceedances, hazard and lengths by the energy with rotation, which is kept, too; call it before the first
  /// batch. Batches must then count it.
  void count_rotation();
  /// The energy with rotation of a cell with a record; nullptr without `keep_energy_total`.
  const EnergyTotal* energy_total(int column, int row) const;

  /// Sets the number of rounds that were added: the weight of each trajectory is divided by it.
  void set_rounds(std::uint32_t rounds);
  const AnnualWeights* weights() const { return hazard_ ? &hazard_->weights : nullptr; }
  /// Only after `keep_hazard`.
  const HazardRules& hazard_rules() const { return hazard_->rules; }
  /// The hazard of a cell; nullptr if no trajectory touched it, or without `keep_hazard`.
  const HazardCell* hazard(int column, int row) const;

  /// Scores a batch: each trajectory once in each cell it visits, with its largest values there. Safe to call from
  /// several threads. Returns the number of (trajectory, cell) pairs scored.
  std::uint64_t add(const VisitBatch& batch);

  const Grid& grid() const { return grid_; }
  MemoryPolicy memory() const { return regions_.get_deleter().memory; }
  const Thresholds& thresholds() const { return thresholds_; }

  /// The record of a cell; nullptr if no trajectory touched it.
  const CellRecord* find(int column, int row) const;
  /// Prefetches the record of a cell that is read soon: records are scattered, and reading would wait for each.
  void prefetch_record(int column, int row) const;
  /// Number of trajectories whose largest value in the cell exceeds each threshold, quantity by quantity. Only for
  /// cells with a record.
  const std::uint32_t* exceedances(int column, int row) const;
  /// Plan length above each energy threshold [CellRecord::kLengthUnit]. Only for cells with a record.
  const std::int64_t* lengths_above(int column, int row) const;
  std::uint64_t touched_cells() const;
  /// Number of touched cells with 0, 1, 2, ... trajectories; the last number is of `most` or more.
  std::vector<std::uint64_t> cells_by_passages(std::uint32_t most) const;

  /// Whether any cell of a region has a record.
  bool is_touched(std::size_t region) const;

  /// Number of regions. They are numbered row by row from the south-west.
  std::size_t regions() const { return layout_.count(); }
  /// Writes the records of a region; nothing if no trajectory touched it. Not while batches are added.
  void save(std::size_t region, ByteWriter& out) const;
  /// Writes the records of a region and deletes them.
  void take(std::size_t region, ByteWriter& out);
  /// Adds what another tally of the same grid, thresholds and weights saved. Throws std::out_of_range if the bytes
  /// cannot be that.
  void merge(std::size_t region, ByteReader& in);

 private:
  struct Region;
  struct Group;
  struct Work;
  /// Destroys the regions. Those in a scratch file are dropped with the file, without reading them.
  struct EndRegions {
    MemoryPolicy memory;
    std::size_t count = 0;
    void operator()(Region* regions) const noexcept;
  };
  struct Hazard {
    HazardRules rules;
    AnnualWeights weights;
  };

  /// Where the record of a cell is.
  struct Place {
    const Region& region;
    std::size_t record;  // its index in the region, or kNoRecord
  };
  static constexpr std::size_t kNoRecord = ~std::size_t{0};

  Place place_of(int column, int row) const;
  std::uint64_t score(std::size_t index, const RegionVisits& visits, const VisitBatch& batch, Work& work);
  void add_lengths(const Group& group, std::span<const float> mixed, const VisitBatch& batch, Region& region) const;
  void add_weighted_lengths(const Group& group, std::span<const float> mixed, const VisitBatch& batch,
                            HazardCell& hazard) const;
  std::size_t energy_thresholds() const { return thresholds_[Quantity::Energy].size(); }
  std::span<const float> counted(Quantity quantity, const CellValues& values) const;
  void count_exceedances(std::uint32_t* over, const CellValues& values, const PerQuantity<float>& largest) const;

  Grid grid_;
  Thresholds thresholds_;
  PerQuantity<std::vector<float>> limits_;  // the thresholds for values, which are floats
  std::size_t threshold_count_;             // of all quantities
  Regions layout_;
  bool keep_total_ = false, count_rotation_ = false;
  std::unique_ptr<Hazard> hazard_;  // null: hazard is not counted
  std::unique_ptr<Region[], EndRegions> regions_;
};

}  // namespace talus
