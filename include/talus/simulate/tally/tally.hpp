#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "talus/simulate/tally/hazard_tally.hpp"
#include "talus/simulate/tally/histogram.hpp"
#include "talus/simulate/tally/source_reach.hpp"
#include "talus/simulate/tally/visits.hpp"

namespace talus {

/// The three quantities that are kept per cell: of each trajectory its largest value in the cell.
enum class Quantity { Energy, Speed, Height };  // translational kinetic [kJ], [m/s], vertical above the terrain [m]
inline constexpr int kQuantities = 3;

/// What is known of one cell. Only integer sums, maxima and histograms: equal bits in any order of the trajectories.
struct CellRecord {
  std::uint64_t impacts = 0;
  std::uint32_t passages = 0, deposits = 0, sources = 0;
  std::array<float, kQuantities> maximum{};
  std::array<std::int64_t, kQuantities> sum{};  ///< fixed point, in units of kFixedPoint
  std::array<LogHistogram, kQuantities> histogram;

  CellRecord() = default;
  explicit CellRecord(MemoryPolicy memory) {
    for (LogHistogram& h : histogram) h = LogHistogram(memory);
  }
  double mean(Quantity q) const;
  void merge(const CellRecord& other);
  void save(ByteWriter& out) const;
  static CellRecord restored(ByteReader& in);
};

/// Units of the sums: 2^-10 kJ, 2^-16 m/s, 2^-16 m.
inline constexpr std::array<double, kQuantities> kFixedPoint{0x1p-10, 0x1p-16, 0x1p-16};

/// Sums over trajectories, per cell, in memory bounded by the cells that any trajectory touched.
///
/// The grid is cut into regions of 64 x 64 cells. A region is allocated when it is first touched, and a record in it
/// when its cell is. Workers share the one tally: each locks the region it scores.
class Tally {
 public:
  /// By quantity: one value of each trajectory. A buffer that keeps its memory.
  struct Values {
    std::array<std::vector<float>, kQuantities> lists;
    std::vector<Stake> stakes;  // of each value, where `keep_stakes`
    bool keep_stakes = false;
    std::size_t count = 0;

    void make_room(std::size_t n) {
      if (keep_stakes && stakes.size() < n) stakes.resize(n);
      if (lists[0].size() < n)
        for (std::vector<float>& list : lists) list.resize(n);
    }
    std::span<const float> of(std::size_t quantity) const { return {lists[quantity].data(), count}; }
  };

  /// @param memory  where the records lie
  Tally(const Grid& grid, std::vector<double> energy_thresholds, std::vector<double> height_thresholds,
        MemoryPolicy memory = {});
  ~Tally();
  Tally(Tally&&) noexcept;

  /// Keeps annual frequencies by energy too; before the first batch. Trajectories must then have their stakes.
  void keep_hazard(AnnualWeights weights);
  /// Says how many rounds of the scenario's trajectories were added: each then stands for so much less.
  void set_rounds(std::uint32_t rounds);
  const AnnualWeights* weights() const { return hazard_ ? &hazard_->weights : nullptr; }
  /// How the hazard of a cell is kept. Only where it is.
  const HazardRules& hazard_rules() const { return hazard_->rules; }
  /// The hazard of a cell; nullptr where no trajectory was, or none is kept.
  const HazardCell* hazard(int column, int row) const;

  /// Scores a batch: each trajectory once in each cell it visits, with its largest values there. Safe to call from
  /// several threads. Returns the number of (trajectory, cell) pairs scored.
  std::uint64_t add(const VisitBatch& batch);

  const Grid& grid() const { return grid_; }
  MemoryPolicy memory() const { return regions_.get_deleter().memory; }
  const std::vector<double>& energy_thresholds() const { return energy_thresholds_; }
  const std::vector<double>& height_thresholds() const { return height_thresholds_; }

  /// The record of a cell; nullptr where no trajectory was.
  const CellRecord* find(int column, int row) const;
  /// Trajectories whose largest value in the cell exceeds each threshold: energies first, then heights. For cells that
  /// `find` finds.
  const std::uint32_t* exceedances(int column, int row) const;
  std::uint64_t touched_cells() const;
  /// How many cells have so many trajectories; 0, 1, 2, ... up to `most`, and there all with more.
  std::vector<std::uint64_t> cells_by_passages(std::uint32_t most) const;

  /// What is kept of a region, for a file; nothing where no trajectory was. Regions are numbered row by row from the
  /// south-west; not while batches are added.
  std::size_t regions() const { return region_count_; }
  void save(std::size_t region, ByteWriter& out) const;
  /// The same, and then nothing is kept of the region any more.
  void take(std::size_t region, ByteWriter& out);
  /// Adds what another tally of the same grid, thresholds and weights saved. Throws std::out_of_range where the bytes
  /// cannot be that.
  void merge(std::size_t region, ByteReader& in);

 private:
  struct Region;
  /// Ends the regions. All of those in a scratch file ends with the file, unread.
  struct EndRegions {
    MemoryPolicy memory;
    std::size_t count = 0;
    void operator()(Region* regions) const noexcept;
  };
  struct Hazard {
    HazardRules rules;
    AnnualWeights weights;
  };

  const Region& region_of(int column, int row) const;
  std::size_t thresholds() const { return energy_thresholds_.size() + height_thresholds_.size(); }
  std::uint64_t score(std::size_t index, const std::vector<Visit>& visits, const VisitBatch& batch);
  void add(CellRecord& record, std::uint32_t* over, const Values& values) const;

  Grid grid_;
  std::vector<double> energy_thresholds_, height_thresholds_;
  std::vector<float> energy_limits_, height_limits_;  // the same for values, which are floats
  int regions_across_ = 0;
  std::size_t region_count_ = 0;
  std::unique_ptr<Hazard> hazard_;  // null: none is kept
  std::unique_ptr<Region[], EndRegions> regions_;
};

}  // namespace talus
