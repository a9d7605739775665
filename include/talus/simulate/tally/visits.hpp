#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "talus/physics/path.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/simulate/tally/quantities.hpp"
#include "talus/simulate/tally/source_reach.hpp"

namespace talus {

/// One way of a trajectory through a cell, with the largest values on it. A trajectory that comes back has several
/// visits to the cell; scoring joins them.
struct Visit : Maxima {
  std::uint16_t cell;        ///< within its region: row * kRegionSide + column
  std::uint16_t trajectory;  ///< within its batch
  std::uint32_t impacts : 29;
  std::uint32_t deposited : 1;  ///< the path ends here: the block stays
  std::uint32_t trapped : 1;    ///< it stays because it is trapped
  std::uint32_t left : 1;       ///< the path leaves the terrain from here
};

/// The visits of a batch of trajectories, collected by region of the grid: the tally is written region by region and
/// cell by cell, not along each path.
class VisitBatch {
 public:
  struct Trajectory {
    double mass;  // [kg]
    std::uint32_t source;
    std::shared_ptr<SourceReach> reach;  // of a source cell that several batches share; else empty
    bool piece = false;                  // counts as one with the trajectory before it
    Stake stake{};                       // if the run has frequencies
  };

  explicit VisitBatch(const Grid& grid);

  /// Reads a path. Within a cell the largest speed and clearance are exact, not sampled: both are closed forms on each
  /// patch (the speed is largest at an end, the clearance at an end or at the apex).
  /// The rest of a block that broke, and a path with `piece`, count as one with the trajectory before them.
  void add(const Path& path, double mass, std::uint32_t source, std::shared_ptr<SourceReach> reach, bool piece = false);

  /// Sets the stake of the trajectories that are added from here on.
  void set_stake(const Stake& stake) { stake_ = stake; }

  bool full() const { return size_ >= kVisits || trajectories_.size() >= kTrajectories; }
  void clear();

  const std::vector<Trajectory>& trajectories() const { return trajectories_; }
  const std::unordered_map<std::size_t, std::vector<Visit>>& regions() const { return regions_; }

 private:
  static constexpr std::size_t kVisits = 7U << 17U;  // 14 MB
  static constexpr std::size_t kTrajectories = 60'000;

  Visit& visit(int column, int row) {
    return column == column_ && row == row_ ? region_->back() : new_visit(column, row);
  }
  Visit& new_visit(int column, int row);
  void begin(Trajectory trajectory);
  void add(std::span<const Span> spans);

  int regions_across_;
  std::unordered_map<std::size_t, std::vector<Visit>> regions_;
  std::vector<Trajectory> trajectories_;
  Stake stake_;
  std::size_t size_ = 0;
  int column_ = -1, row_ = -1;            // cell of the current visit
  std::vector<Visit>* region_ = nullptr;  // its last element is the current visit
  std::size_t region_index_ = 0;
};

}  // namespace talus
