#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "talus/base/expect.hpp"
#include "talus/simulate/tally/cell_record.hpp"
#include "talus/simulate/tally/source_reach.hpp"
#include "talus/simulate/tally/visits.hpp"

namespace talus {

/// The cells of a region that the source cell of a trajectory has reached, in this batch or another.
class ReachOf {
 public:
  ReachOf(const VisitBatch& batch, std::size_t region) : batch_(batch), region_(region) {}

  /// Whether the source cell reaches the cell for the first time; then marks it as reached. Trajectories of one source
  /// cell follow each other, so only the first one in a group is tested.
  bool first(std::uint16_t trajectory, std::size_t cell) {
    const VisitBatch::Trajectory& t = batch_.trajectories()[trajectory];
    if (!t.reach) return true;
    if (t.reach.get() != reach_) {
      reach_ = t.reach.get();
      cells_ = &reach_->cells(region_);
    }
    if ((*cells_)[cell]) return false;
    return (*cells_)[cell] = true;
  }

 private:
  const VisitBatch& batch_;
  std::size_t region_;
  SourceReach* reach_ = nullptr;
  SourceReach::Cells* cells_ = nullptr;
};

/// Whether two trajectories of a batch, `first` before `second`, come from the same block.
inline bool of_one_block(const VisitBatch& batch, std::uint16_t first, std::uint16_t second) {
  const auto& all = batch.trajectories();
  return std::all_of(&all[first] + 1, &all[second] + 1, [](const VisitBatch::Trajectory& t) { return t.piece; });
}

/// Ends of paths in a cell.
struct PathEnds {
  bool deposited = false, trapped = false, left = false;
};

/// Adds the ends of a path to the record, except those that its block already has in this cell: all pieces of a block
/// count once.
inline void count_ends(const PathEnds& ends, PathEnds& of_block, CellRecord& record) {
  const auto count = [](bool ended, bool& before, std::uint32_t& sum) {
    sum += ended && !before ? 1U : 0U;
    before = before || ended;
  };
  count(ends.deposited, of_block.deposited, record.deposits);
  count(ends.trapped, of_block.trapped, record.trapped);
  count(ends.left, of_block.left, record.exits);
}

/// The visits of one trajectory to a cell, joined.
struct JoinedVisits {
  Maxima largest;
  PathEnds ends;
};

/// Joins the visits of the next trajectory and moves `visit` past them; adds their impacts to the record.
inline JoinedVisits next_visits(const Visit*& visit, const Visit* end, CellRecord& record) {
  const std::uint16_t trajectory = visit->trajectory;
  JoinedVisits here;
  for (; visit != end && visit->trajectory == trajectory; ++visit) {
    here.largest.raise(*visit);
    record.impacts += visit->impacts;
    here.ends.deposited |= visit->deposited != 0;
    here.ends.trapped |= visit->trapped != 0;
    here.ends.left |= visit->left != 0;
  }
  return here;
}

/// Sets the values of each trajectory, the largest of its visits, and adds the counts of the visits to the record.
[[gnu::always_inline]] inline void gather(std::span<const Visit> visits, const VisitBatch& batch, CellValues& values,
                                          CellRecord& record, ReachOf& reach) {
  values.make_room(visits.size());
  const Visit* const end = visits.data() + visits.size();
  std::size_t n = 0;
  std::uint32_t source = 0;
  std::uint16_t previous = 0;  // the trajectory of the last value
  PathEnds ends;               // of the block and its pieces, in this cell
  for (const Visit* visit = visits.data(); visit != end;) {
    const std::uint16_t trajectory = visit->trajectory;
    const JoinedVisits here = next_visits(visit, end, record);
    const VisitBatch::Trajectory& of = batch.trajectories()[trajectory];
    if (of.piece && n > 0 && of_one_block(batch, previous, trajectory)) {  // all pieces of a block have one value
      count_ends(here.ends, ends, record);
      for_each_quantity([&](auto q) {
        float& value = values.lists[q][n - 1];
        value = std::max(value, kQuantityTable[q].value(here.largest, of.size.mass));
      });
      continue;
    }
    previous = trajectory;
    ends = {};
    count_ends(here.ends, ends, record);
    if (n == 0 || of.source != source) {
      source = of.source;
      record.sources += reach.first(trajectory, visits.front().cell) ? 1U : 0U;
    }
    if (values.keep_annual_shares) values.annual_shares[n] = of.annual_share;
    for_each_quantity([&](auto q) { values.lists[q][n] = kQuantityTable[q].value(here.largest, of.size.mass); });
    ++n;
  }
  TALUS_EXPECT(n > 0, "a group of visits has a value");
  values.count = n;
}

/// Sets the energy with rotation of each trajectory, the largest of its visits, as `gather` the other values.
inline void gather_totals(std::span<const Visit> visits, std::span<const float> squares, const VisitBatch& batch,
                          std::vector<float>& totals) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < visits.size();) {
    const std::uint16_t trajectory = visits[i].trajectory;
    const bool piece = n > 0 && batch.has_pieces() && of_one_block(batch, visits[i - 1].trajectory, trajectory);
    Maxima largest;
    for (; i < visits.size() && visits[i].trajectory == trajectory; ++i)
      largest.speed_squared = std::max(largest.speed_squared, squares[i]);
    const double mass = batch.trajectories()[trajectory].size.mass;
    const float total = kQuantityTable[index_of(Quantity::Energy)].value(largest, mass);
    totals[n - (piece ? 1 : 0)] = piece ? std::max(totals[n - 1], total) : total;
    n += piece ? 0 : 1;
  }
}

}  // namespace talus
