#include "talus/simulate/tally/barrier_counts.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/expect.hpp"

namespace talus {

BarrierTally::BarrierTally(const Barriers& barriers) {
  for (std::size_t i = 0; i < barriers.list().size(); ++i)
    parts_.emplace_back(
        std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(barriers.length(i) / kBarrierPart))));
}

void BarrierTally::add(const Path& path) {
  for (const BarrierPassage& passage : path.barriers) {
    TALUS_EXPECT(passage.barrier < parts_.size() && passage.along >= 0.0, "a passage is of a barrier of the scenario");
    std::vector<BarrierCounts>& parts = parts_[passage.barrier];
    BarrierCounts& part = parts[std::min(parts.size() - 1, static_cast<std::size_t>(passage.along / kBarrierPart))];
    (passage.how == Meeting::Over ? part.over : passage.how == Meeting::Caught ? part.caught : part.broken) += 1;
  }
}

void BarrierTally::merge(const BarrierTally& other) {
  TALUS_EXPECT(parts_.size() == other.parts_.size(), "what is added is of the same barriers");
  for (std::size_t i = 0; i < parts_.size(); ++i)
    for (std::size_t k = 0; k < parts_[i].size(); ++k) parts_[i][k].add(other.parts_[i][k]);
}

void BarrierTally::save(ByteWriter& out) const {
  for (const auto& parts : parts_) out.put_all(std::span<const BarrierCounts>(parts));
}

BarrierTally BarrierTally::restored(const Barriers& barriers, ByteReader& in) {
  BarrierTally tally(barriers);
  for (auto& parts : tally.parts_) {
    auto kept = in.get_all<BarrierCounts>();
    if (kept.size() != parts.size()) throw std::out_of_range("parts of a barrier");
    parts = std::move(kept);
  }
  return tally;
}

BarrierCounts BarrierTally::sum(std::size_t barrier) const {
  BarrierCounts sum;
  for (const BarrierCounts& part : parts_[barrier]) sum.add(part);
  return sum;
}

}  // namespace talus
