#include "talus/simulate/visits.hpp"

#include <algorithm>

namespace talus {
namespace {

/// The motion at a share of the way along a span.
struct Moment {
  float share, height, rise;
};

/// Raises the maxima of a visit to those of a part of a span: the speed is largest at an end, the height at an end or,
/// where it rises from the first and falls to the second, at the apex between.
inline void raise(Visit& visit, const Span& span, const Moment& from, const Moment& to) {
  const float rise_squared = std::max(from.rise * from.rise, to.rise * to.rise);
  const float slope = span.height_to - span.height_from - span.bend;  // dh/ds = slope + 2 bend s
  const bool apex = slope + 2.0F * span.bend * from.share > 0.0F && slope + 2.0F * span.bend * to.share < 0.0F;
  const float top = span.height_from - 0.25F * slope * slope / span.bend;  // of no use where there is no apex
  const float highest = apex ? top : std::max(from.height, to.height);
  visit.speed_squared = std::max(visit.speed_squared, span.plan_speed_squared + rise_squared);
  visit.height = std::max(visit.height, highest);
}

}  // namespace

VisitBatch::VisitBatch(const Grid& grid) : regions_across_((grid.columns + kRegionSide - 1) / kRegionSide) {}

void VisitBatch::clear() {
  regions_.clear();
  trajectories_.clear();
  size_ = 0;
}

void VisitBatch::add(const Path& path, double mass, std::uint32_t source, std::shared_ptr<SourceReach> reach) {
  trajectories_.push_back({mass, source, std::move(reach)});
  column_ = row_ = -1;
  region_ = nullptr;
  region_index_ = static_cast<std::size_t>(-1);
  for (const Span& span : path.spans) {
    const bool east_from = span.p_from >= 0.5F, east_to = span.p_to >= 0.5F;
    const bool north_from = span.q_from >= 0.5F, north_to = span.q_to >= 0.5F;
    if (east_from == east_to && north_from == north_to) {  // most spans lie in one cell
      raise(visit(span.patch.column + (east_from ? 1 : 0), span.patch.row + (north_from ? 1 : 0)), span,
            {0.0F, span.height_from, span.rise_from}, {1.0F, span.height_to, span.rise_to});
    } else {
      cross(span, east_from != east_to, north_from != north_to);
    }
    if (span.impact) region_->back().impacts = (region_->back().impacts + 1U) & 0x7FFFFFFFU;
  }
  if (region_ != nullptr) region_->back().deposited = path.end == End::Stopped || path.end == End::Caught;
}

/// Cuts a span where it changes its cell and scores the two or three parts.
void VisitBatch::cross(const Span& span, bool p_turns, bool q_turns) {
  float first = 1.0F, second = 1.0F;  // shares of the way
  if (p_turns) first = (0.5F - span.p_from) / (span.p_to - span.p_from);
  if (q_turns) second = (0.5F - span.q_from) / (span.q_to - span.q_from);
  if (second < first) std::swap(first, second);
  Moment from{0.0F, span.height_from, span.rise_from};
  for (const float share : {first, second, 1.0F}) {
    if (share <= from.share && from.share > 0.0F) continue;
    const float middle = 0.5F * (from.share + share);
    const float p = span.p_from + (span.p_to - span.p_from) * middle;
    const float q = span.q_from + (span.q_to - span.q_from) * middle;
    const Moment to{share,
                    span.height_from + share * (span.height_to - span.height_from - span.bend * (1.0F - share)),
                    span.rise_from + (span.rise_to - span.rise_from) * share};
    raise(visit(span.patch.column + (p >= 0.5F ? 1 : 0), span.patch.row + (q >= 0.5F ? 1 : 0)), span, from, to);
    from = to;
  }
}

Visit& VisitBatch::new_visit(int column, int row) {
  column_ = column;
  row_ = row;
  const std::size_t index = static_cast<std::size_t>(row / kRegionSide) * static_cast<std::size_t>(regions_across_) +
                            static_cast<std::size_t>(column / kRegionSide);
  if (index != region_index_) {
    region_index_ = index;
    region_ = &regions_[index];
  }
  const auto cell = static_cast<std::uint16_t>(row % kRegionSide * kRegionSide + column % kRegionSide);
  region_->push_back({cell, static_cast<std::uint16_t>(trajectories_.size() - 1), 0.0F, 0.0F, 0, 0});
  ++size_;
  return region_->back();
}

}  // namespace talus
