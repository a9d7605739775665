#include "talus/simulate/plan/work_units.hpp"

#include <algorithm>

#include "talus/base/expect.hpp"

namespace talus {

WorkUnits::WorkUnits(ProcessGroup& processes, const Range& range, std::uint64_t chunk, bool fixed)
    : processes_(processes),
      range_(range),
      chunk_(chunk),
      chunks_((range.end + chunk - 1) / chunk),
      fixed_(fixed),
      closed_at_(chunks_) {
  TALUS_EXPECT(chunk > 0 && range.first <= range.end, "there are units to hand out");
  const std::uint64_t first = range.first / chunk, size = static_cast<std::uint64_t>(processes.size());
  mine_ = first + (static_cast<std::uint64_t>(processes.rank()) + size - first % size) % size;
  processes_.set_counter(fixed ? 0 : first);
}

/// The next chunk for this process; `chunks_` or more if there is none.
std::uint64_t WorkUnits::next_chunk() {
  if (!fixed_) return processes_.take(1);
  if (mine_ >= chunks_ || (!catching_up_ && processes_.take(0) >= ProcessGroup::kClosed)) return chunks_;
  const std::uint64_t chunk = mine_;
  mine_ += static_cast<std::uint64_t>(processes_.size());
  return chunk;
}

std::optional<WorkUnits::Taken> WorkUnits::next() {
  const std::lock_guard guard(mutex_);
  processes_.attend();
  while (at_ == till_) {  // a chunk of an empty range may be empty
    const std::uint64_t chunk = next_chunk();
    if (chunk >= chunks_) return std::nullopt;
    at_ = std::max(range_.first, chunk * chunk_);
    till_ = std::min(range_.end, (chunk + 1) * chunk_);
  }
  TALUS_EXPECT(at_ >= range_.first && at_ < range_.end, "a unit is one of those asked for");
  return Taken{at_++, taken_++};
}

void WorkUnits::stop() {
  const std::uint64_t at = processes_.close();
  const std::lock_guard guard(mutex_);
  if (!fixed_) closed_at_ = std::min(closed_at_, at);
}

bool WorkUnits::agree_on_end() {
  if (!fixed_) {
    end_ = std::min(range_.end, chunk_ * processes_.smallest(closed_at_));
    return true;
  }
  if (catching_up_) {
    processes_.largest(0);  // the others have caught up, too
    return true;
  }
  const bool closed = processes_.largest(processes_.take(0)) >= ProcessGroup::kClosed;
  const auto size = static_cast<std::uint64_t>(processes_.size());
  const std::uint64_t begun = mine_ >= size ? mine_ - size + 1 : 0;  // one beyond the last chunk that this process took
  if (closed) chunks_ = std::min(chunks_, std::max(range_.first / chunk_, processes_.largest(begun)));
  end_ = std::min(range_.end, chunk_ * chunks_);
  catching_up_ = true;
  return false;
}

}  // namespace talus
