#include "talus/simulate/units.hpp"

#include <algorithm>

namespace talus {

Team& alone() {
  thread_local Team one;  // simulations of several threads must not share its counter
  return one;
}

Units::Units(Team& team, const Range& range, std::uint64_t chunk, bool fixed)
    : team_(team),
      range_(range),
      chunk_(chunk),
      chunks_((range.end + chunk - 1) / chunk),
      fixed_(fixed),
      closed_at_(chunks_) {
  const std::uint64_t first = range.first / chunk, size = static_cast<std::uint64_t>(team.size());
  mine_ = first + (static_cast<std::uint64_t>(team.rank()) + size - first % size) % size;
  team_.set_counter(fixed ? 0 : first);
}

/// The chunk that is to be traced next; `chunks_` or more where there is none.
std::uint64_t Units::next_chunk() {
  if (!fixed_) return team_.take(1);
  if (mine_ >= chunks_ || (!catching_up_ && team_.take(0) >= Team::kClosed)) return chunks_;
  const std::uint64_t chunk = mine_;
  mine_ += static_cast<std::uint64_t>(team_.size());
  return chunk;
}

std::optional<Units::Taken> Units::next() {
  const std::lock_guard guard(mutex_);
  team_.attend();
  while (at_ == till_) {  // of an empty range a chunk may be empty
    const std::uint64_t chunk = next_chunk();
    if (chunk >= chunks_) return std::nullopt;
    at_ = std::max(range_.first, chunk * chunk_);
    till_ = std::min(range_.end, (chunk + 1) * chunk_);
  }
  return Taken{at_++, taken_++};
}

void Units::stop() {
  const std::uint64_t at = team_.close();
  const std::lock_guard guard(mutex_);
  if (!fixed_) closed_at_ = std::min(closed_at_, at);
}

bool Units::finish() {
  if (!fixed_) {
    end_ = std::min(range_.end, chunk_ * team_.smallest(closed_at_));
    return true;
  }
  if (catching_up_) {
    team_.largest(0);  // the others have caught up, too
    return true;
  }
  const bool closed = team_.largest(team_.take(0)) >= Team::kClosed;
  const auto size = static_cast<std::uint64_t>(team_.size());
  const std::uint64_t begun = mine_ >= size ? mine_ - size + 1 : 0;  // one beyond the last chunk that this one took
  if (closed) chunks_ = std::min(chunks_, std::max(range_.first / chunk_, team_.largest(begun)));
  end_ = std::min(range_.end, chunk_ * chunks_);
  catching_up_ = true;
  return false;
}

}  // namespace talus
