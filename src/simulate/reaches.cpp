#include "talus/simulate/reaches.hpp"

namespace talus {

Reaches::~Reaches() {
  for (auto& [place, entry] : open_) {
    memory_.keep_below_limit();  // cells in the scratch file are read once more
    entry.reach.reset();
  }
}

std::shared_ptr<SourceReach> Reaches::of(std::uint32_t place) {
  if (units_ == 1 && !keep_) return nullptr;
  const std::lock_guard guard(mutex_);
  const auto it = open_.try_emplace(place).first;
  if (!it->second.reach) it->second.reach = std::make_shared<SourceReach>(memory_);
  std::shared_ptr<SourceReach> reach = it->second.reach;
  if (++it->second.asked == units_ && !keep_) open_.erase(it);
  return reach;
}

void Reaches::save(const std::function<void(std::string_view)>& put) const {
  ByteWriter out;
  for (const auto& [place, entry] : open_) {
    memory_.keep_below_limit();
    out.clear();
    out.put(place);
    out.put(entry.asked);
    entry.reach->save(out);
    put(out.bytes());
  }
}

void Reaches::restore(ByteReader& in, const std::function<bool(std::uint32_t)>& wanted) {
  memory_.keep_below_limit();
  const auto place = in.get<std::uint32_t>();
  if (!wanted(place)) return;
  Entry& entry = open_[place];
  entry.asked = in.get<std::uint32_t>();
  entry.reach = std::make_shared<SourceReach>(memory_);
  entry.reach->restore(in);
}

}  // namespace talus
