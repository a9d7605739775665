#include "talus/simulate/tally/tally_exchange.hpp"

#include <algorithm>

#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr std::size_t kAtATime = 64;  // regions: some 100 MB if every cell was reached

/// Appends a region as bytes: its number, its length, and the bytes of `Tally::take`.
void append(std::string& bytes, std::size_t region, Tally& tally) {
  ByteWriter content;
  tally.take(region, content);
  if (content.bytes().empty()) return;
  ByteWriter head;
  head.put(std::uint64_t{region});
  head.put(std::uint64_t{content.bytes().size()});
  bytes += head.bytes() + content.bytes();
}

void merge(std::string_view bytes, Tally& tally) {
  while (!bytes.empty()) {
    ByteReader head(bytes);
    const auto region = head.get<std::uint64_t>(), length = head.get<std::uint64_t>();
    bytes.remove_prefix(2 * sizeof(std::uint64_t));
    TALUS_EXPECT(region < tally.regions() && length <= bytes.size(), "processes have tallies of the same grid");
    ByteReader content(bytes.substr(0, length));
    tally.merge(region, content);
    bytes.remove_prefix(length);
  }
}

}  // namespace

void share_out(Tally& tally, ProcessGroup& processes) {
  if (processes.size() == 1) return;
  const auto size = static_cast<std::size_t>(processes.size()), me = static_cast<std::size_t>(processes.rank());
  for (std::size_t from = 0; from < tally.regions(); from += kAtATime) {
    std::vector<std::string> to(size);
    for (std::size_t region = from; region < std::min(from + kAtATime, tally.regions()); ++region)
      if (region % size != me) append(to[region % size], region, tally);
    for (const std::string& bytes : processes.exchange(std::move(to))) merge(bytes, tally);
  }
}

void collect(Tally& tally, ProcessGroup& processes) {
  share_out(tally, processes);
  if (processes.size() == 1) return;
  for (std::size_t from = 0; from < tally.regions(); from += kAtATime) {
    std::string bytes;
    for (std::size_t region = from; region < std::min(from + kAtATime, tally.regions()) && !processes.leads(); ++region)
      append(bytes, region, tally);
    for (const std::string& given : processes.gather(std::move(bytes))) merge(given, tally);
  }
}

}  // namespace talus
