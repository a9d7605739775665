#include "talus/simulate/tally/visits.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

#include "span_length.hpp"
#include "span_maxima.hpp"
#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr std::uint32_t kMostImpacts = (1U << 22U) - 1;  // of a visit: what its field holds

}  // namespace

LengthRules length_rules(const OutputSettings& output) {
  LengthRules rules{output.energy_thresholds};
  if (output.passages_below > 0.0) rules.below = output.passages_below;
  rules.with_rotation = output.count_rotation;
  return rules;
}

void VisitList::append_piece(std::vector<Piece>& spare) {
  if (spare.empty()) spare.push_back(std::make_unique_for_overwrite<Visit[]>(kPiece));
  pieces_.push_back(std::move(spare.back()));
  spare.pop_back();
  used_ = 0;
}

void VisitList::clear(std::vector<Piece>& spare) {
  std::ranges::move(pieces_, std::back_inserter(spare));
  pieces_.clear();
}

VisitBatch::VisitBatch(const Grid& grid, LengthRules lengths)
    : grid_(grid),
      lengths_(std::move(lengths)),
      limits_(lengths_.energies.size()),
      here_(lengths_.levels()),
      layout_(grid),
      keep_total_(lengths_.with_rotation) {}

void VisitBatch::clear() {
  for (auto region = regions_.begin(); region != regions_.end();) {
    if (region->second.visits.empty()) {
      region = regions_.erase(region);  // not visited by this batch: the work has moved on
    } else {
      region->second.visits.clear(spare_);
      region->second.lengths.clear();
      region->second.totals.clear();
      ++region;
    }
  }
  trajectories_.clear();
  size_ = 0;
  pieces_ = false;
}

void VisitBatch::begin(Trajectory trajectory) {
  close_visit();
  trajectories_.push_back(std::move(trajectory));
  trajectories_.back().annual_share = annual_share_;
  pieces_ = pieces_ || trajectories_.back().piece;
  set_limits(0.0);
  column_ = row_ = -1;
  region_ = nullptr;
  region_index_ = static_cast<std::size_t>(-1);
}

/// Sets the squares of the speed at which the energy of the current trajectory is at each threshold.
/// @param rotation  twice the energy of its rotation per mass, if that counts [m^2/s^2]; limits below 0 are exceeded
void VisitBatch::set_limits(double rotation) {
  const double mass = trajectories_.back().size.mass;
  for (std::size_t i = 0; i < limits_.size(); ++i)
    limits_[i] = static_cast<float>(2e3 * lengths_.energies[i] / mass - rotation);
}

void VisitBatch::add(const Path& path, BlockSize size, std::uint32_t source, std::shared_ptr<SourceReach> reach,
                     bool piece) {
  const std::span<const Span> spans(path.spans);
  std::size_t from = 0;
  for (const Broken& broken : path.breaks) {
    begin({size, source, reach, piece});
    add(path, from, broken.span);
    from = broken.span;
    size = broken.body;
    piece = true;
  }
  if (from < spans.size() || path.breaks.empty()) {  // otherwise it stopped where it broke: its last span is above
    begin({size, source, std::move(reach), piece});
    add(path, from, spans.size());
  }
  if (region_ == nullptr) return;
  Visit& last = *visit_;
  last.deposited = rests(path.end) ? 1 : 0;
  last.trapped = path.end == End::Trapped ? 1 : 0;
  last.left = path.end == End::Left ? 1 : 0;
  close_visit();
  region_ = nullptr;
}

/// Adds the spans [from, to) of a path, for the energy with rotation spin by spin.
void VisitBatch::add(const Path& path, std::size_t from, std::size_t to) {
  const std::span<const Span> spans(path.spans);
  if (!keep_total_) {
    add(spans.subspan(from, to - from));
    return;
  }
  const BlockSize& size = trajectories_.back().size;
  const Block body{size.diameter, size.mass};
  auto spin = std::ranges::upper_bound(path.spins, from, {}, &SpinFrom::span);  // the first one after `from`
  while (from < to) {
    rotation_ = spin == path.spins.begin()
                    ? 0.0F
                    : static_cast<float>(2e3 / body.mass * body.rotational_energy_kj(std::prev(spin)->spin));
    if (lengths_.with_rotation) set_limits(rotation_);
    const std::size_t until = spin == path.spins.end() ? to : std::min(to, spin->span);
    add(spans.subspan(from, until - from));
    from = until;
    while (spin != path.spins.end() && spin->span <= from) ++spin;
  }
}

/// Raises the energy with rotation of the current visit to its largest value on a part of a span: the speed is largest
/// at an end, the spin is constant.
void VisitBatch::raise_total(const Span& span, const Moment& from, const Moment& to) {
  float& total = region_->totals.back();
  total = std::max(total, rotation_ + largest_speed_squared(span, from, to));
}

void VisitBatch::add(std::span<const Span> spans) {
  for (const Span& span : spans) {
    const int east_from = span.p_from >= 0.5F, east_to = span.p_to >= 0.5F;
    const int north_from = span.q_from >= 0.5F, north_to = span.q_to >= 0.5F;
    const Moment start{0.0F, span.height_from, span.rise_from}, end{1.0F, span.height_to, span.rise_to};
    const float length = plan_length(span);
    const std::size_t level = level_of(span);
    float* const pure = level < here_.size() ? &here_[level] : nullptr;
    const auto count = [&](Visit& visit, const Moment& from, const Moment& to) {
      raise(visit, span, from, to);
      if (keep_total_) raise_total(span, from, to);
      if (pure != nullptr)
        *pure += length * (to.share - from.share);
      else
        lengthen(span, length, from, to);
    };
    Visit& first = visit(span.patch.column + east_from, span.patch.row + north_from);
    if (east_from == east_to && north_from == north_to) {
      count(first, start, end);
    } else {  // the way crosses one or both middle lines of the patch, into one or two other cells
      const float p_turn = east_from == east_to ? 2.0F : (0.5F - span.p_from) / (span.p_to - span.p_from);
      const float q_turn = north_from == north_to ? 2.0F : (0.5F - span.q_from) / (span.q_to - span.q_from);
      Moment turn = moment_of(span, std::min(p_turn, q_turn));
      count(first, start, turn);
      if (east_from != east_to && north_from != north_to) {
        const bool east_first = p_turn < q_turn;
        const Moment next = moment_of(span, std::max(p_turn, q_turn));
        count(visit(span.patch.column + (east_first ? east_to : east_from),
                    span.patch.row + (east_first ? north_from : north_to)),
              turn, next);
        turn = next;
      }
      count(visit(span.patch.column + east_to, span.patch.row + north_to), turn, end);
    }
    add_impacts(span.impacts);
  }
}

/// Adds impacts to the current visit; what its field cannot hold goes to further visits of the same cell.
void VisitBatch::add_impacts(std::uint32_t impacts) {
  Visit* last = visit_;
  for (; impacts > kMostImpacts - last->impacts; last = &new_visit(column_, row_)) {
    impacts -= kMostImpacts - last->impacts;
    last->impacts = kMostImpacts;
  }
  last->impacts = (last->impacts + impacts) & kMostImpacts;
}

float VisitBatch::plan_length(const Span& span) const {
  const float east = (span.p_to - span.p_from) * static_cast<float>(grid_.cell_x),
              north = (span.q_to - span.q_from) * static_cast<float>(grid_.cell_y);
  return std::sqrt(east * east + north * north);
}

/// The number of energy thresholds that a whole span is above, if it crosses none and all of it counts. Else a number
/// that is no level.
std::size_t VisitBatch::level_of(const Span& span) const {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  const Moment start{0.0F, span.height_from, span.rise_from}, end{1.0F, span.height_to, span.rise_to};
  if (lengths_.below < kAnyHeight && !(highest(span, start, end) < lengths_.below)) return kNone;
  const SpeedRange speed = speed_range(span, start, end);
  std::size_t level = 0, highest_level = 0;
  for (const float limit : limits_) level += speed.low > limit, highest_level += speed.high > limit;
  return level == highest_level ? level : kNone;
}

/// Adds the length of a part of a span that crosses a limit to the current visit, by level.
void VisitBatch::lengthen(const Span& span, float length, const Moment& from, const Moment& to) {
  const bool low = !(lengths_.below < kAnyHeight) || highest(span, from, to) < lengths_.below;
  const float share = to.share - from.share;
  const SpeedRange speed = speed_range(span, from, to);
  float above = low ? share : counted_share(span, -1.0F, from, to);
  for (std::size_t level = 0; level < here_.size(); ++level) {
    float next = 0.0F;  // share above the next threshold
    if (level < limits_.size() && speed.high > limits_[level]) {
      const float limit = limits_[level];
      if (!low)
        next = counted_share(span, limit, from, to);
      else
        next = speed.low > limit ? share : share_faster(span, limit, from, to);
    }
    here_[level] += length * std::max(0.0F, above - next);
    if (!(next > 0.0F)) break;  // ascending: the rest is not exceeded
    above = next;
  }
}

/// Writes the lengths of the current visit into it.
void VisitBatch::close_visit() {
  if (region_ == nullptr) return;
  Visit& visit = *visit_;
  std::size_t top = here_.size() - 1;
  while (top > 0 && here_[top] == 0.0F) --top;
  bool mixed = false;
  for (std::size_t level = 0; level < top; ++level) mixed = mixed || here_[level] > 0.0F;
  visit.above = top & 0x3FU;  // before `mixed`, one byte of it: in the other order this would wait for that byte
  visit.mixed = mixed;
  visit.length = mixed ? std::bit_cast<float>(static_cast<std::uint32_t>(region_->lengths.size())) : here_[top];
  if (mixed) {
    for (std::size_t level = top; level-- > 0;) here_[level] += here_[level + 1];  // that level and all above it
    region_->lengths.insert(region_->lengths.end(), here_.begin(), here_.end());
    size_ += (here_.size() * sizeof(float) + sizeof(Visit) - 1) / sizeof(Visit);  // their memory, in visits
  }
  for (std::size_t level = 0; level <= top; ++level) here_[level] = 0.0F;
}

/// The share of a span between two moments on which the square of the speed is above `limit` and the clearance is
/// small enough to count.
float VisitBatch::counted_share(const Span& span, float limit, const Moment& from, const Moment& to) const {
  std::array<Quadratic, 2> conditions{speed_squared_along(span), height_along(span)};
  conditions[0].a -= limit;
  Quadratic& h = conditions[1];
  const bool limited = lengths_.below < kAnyHeight;
  if (limited) h = {lengths_.below - h.a, -h.b, -h.c};
  return static_cast<float>(share_above({conditions.data(), limited ? 2U : 1U}, from.share, to.share));
}

Visit& VisitBatch::new_visit(int column, int row) {
  TALUS_EXPECT(column >= 0 && row >= 0 && column / kRegionSide < layout_.across, "a visit lies in the grid");
  TALUS_EXPECT(!trajectories_.empty() && trajectories_.size() <= 0x10000, "a visit is of a trajectory of the batch");
  close_visit();
  column_ = column;
  row_ = row;
  const std::size_t index = layout_.of_cell(column, row);
  if (index != region_index_) {
    region_index_ = index;
    region_ = &regions_[index];
  }
  const auto cell = static_cast<std::uint16_t>(cell_in_region(column, row));
  if (keep_total_) region_->totals.push_back(0.0F);
  const auto trajectory = static_cast<std::uint16_t>(trajectories_.size() - 1);
  size_ -= region_->visits.room();
  visit_ = &region_->visits.append(cell, trajectory, spare_);
  size_ += region_->visits.room();
  return *visit_;
}

}  // namespace talus
