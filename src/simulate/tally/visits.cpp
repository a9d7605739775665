#include "talus/simulate/tally/visits.hpp"

#include <algorithm>

#include "span_maxima.hpp"
#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr std::uint32_t kMostImpacts = (1U << 29U) - 1;  // of a visit: what its field holds

}  // namespace

VisitBatch::VisitBatch(const Grid& grid) : regions_across_((grid.columns + kRegionSide - 1) / kRegionSide) {}

void VisitBatch::clear() {
  for (auto region = regions_.begin(); region != regions_.end();) {
    if (region->second.empty()) {
      region = regions_.erase(region);  // not visited by this batch: the work has moved on
    } else {
      region->second.clear();  // keeps its memory for the next batch
      ++region;
    }
  }
  trajectories_.clear();
  size_ = 0;
}

void VisitBatch::begin(Trajectory trajectory) {
  trajectories_.push_back(std::move(trajectory));
  trajectories_.back().stake = stake_;
  column_ = row_ = -1;
  region_ = nullptr;
  region_index_ = static_cast<std::size_t>(-1);
}

void VisitBatch::add(const Path& path, double mass, std::uint32_t source, std::shared_ptr<SourceReach> reach,
                     bool piece) {
  const std::span<const Span> spans(path.spans);
  std::size_t from = 0;
  for (const Broken& broken : path.breaks) {
    begin({mass, source, reach, piece});
    add(spans.subspan(from, broken.span - from));
    from = broken.span;
    mass = broken.body.mass;
    piece = true;
  }
  if (from < spans.size() || path.breaks.empty()) {  // otherwise it stopped where it broke: its last span is above
    begin({mass, source, std::move(reach), piece});
    add(spans.subspan(from));
  }
  if (region_ == nullptr) return;
  Visit& last = region_->back();
  last.deposited = rests(path.end) ? 1 : 0;
  last.trapped = path.end == End::Trapped ? 1 : 0;
  last.left = path.end == End::Left ? 1 : 0;
}

void VisitBatch::add(std::span<const Span> spans) {
  for (const Span& span : spans) {
    const int east_from = span.p_from >= 0.5F, east_to = span.p_to >= 0.5F;
    const int north_from = span.q_from >= 0.5F, north_to = span.q_to >= 0.5F;
    const Moment start{0.0F, span.height_from, span.rise_from}, end{1.0F, span.height_to, span.rise_to};
    Visit& first = visit(span.patch.column + east_from, span.patch.row + north_from);
    if (east_from == east_to && north_from == north_to) {
      raise(first, span, start, end);
    } else {  // the way crosses one or both middle lines of the patch, into one or two other cells
      const float p_turn = east_from == east_to ? 2.0F : (0.5F - span.p_from) / (span.p_to - span.p_from);
      const float q_turn = north_from == north_to ? 2.0F : (0.5F - span.q_from) / (span.q_to - span.q_from);
      Moment turn = moment_of(span, std::min(p_turn, q_turn));
      raise(first, span, start, turn);
      if (east_from != east_to && north_from != north_to) {
        const bool east_first = p_turn < q_turn;
        const Moment next = moment_of(span, std::max(p_turn, q_turn));
        raise(visit(span.patch.column + (east_first ? east_to : east_from),
                    span.patch.row + (east_first ? north_from : north_to)),
              span, turn, next);
        turn = next;
      }
      raise(visit(span.patch.column + east_to, span.patch.row + north_to), span, turn, end);
    }
    region_->back().impacts = (region_->back().impacts + span.impacts) & kMostImpacts;
  }
}

Visit& VisitBatch::new_visit(int column, int row) {
  TALUS_EXPECT(column >= 0 && row >= 0 && column / kRegionSide < regions_across_, "a visit lies in the grid");
  TALUS_EXPECT(!trajectories_.empty() && trajectories_.size() <= 0x10000, "a visit is of a trajectory of the batch");
  column_ = column;
  row_ = row;
  const std::size_t index = static_cast<std::size_t>(row / kRegionSide) * static_cast<std::size_t>(regions_across_) +
                            static_cast<std::size_t>(column / kRegionSide);
  if (index != region_index_) {
    region_index_ = index;
    region_ = &regions_[index];
  }
  const auto cell = static_cast<std::uint16_t>(row % kRegionSide * kRegionSide + column % kRegionSide);
  region_->push_back({{}, cell, static_cast<std::uint16_t>(trajectories_.size() - 1), 0, 0, 0, 0});
  ++size_;
  return region_->back();
}

}  // namespace talus
