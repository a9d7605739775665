#include "talus/fit/campaign/sites.hpp"

#include <map>
#include <set>

namespace talus {

std::vector<std::vector<std::uint32_t>> streams_of_sites(std::span<const Site> sites) {
  std::map<std::uint32_t, std::size_t> used;  // by how many sites
  for (const Site& site : sites) {
    const std::vector<std::uint32_t> own = streams_of(*site.campaign);
    for (const std::uint32_t stream : std::set<std::uint32_t>(own.begin(), own.end())) ++used[stream];
  }
  std::vector<std::vector<std::uint32_t>> streams;
  for (const Site& site : sites) {
    streams.emplace_back();
    for (const MeasuredBlock& block : site.campaign->blocks)
      streams.back().push_back(used[block.stream] > 1 ? stream_of_name(site.name + "/" + block.id) : block.stream);
  }
  return streams;
}

void give_own_streams(std::span<const Site> sites) {
  const std::vector<std::vector<std::uint32_t>> streams = streams_of_sites(sites);
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (std::size_t b = 0; b < streams[i].size(); ++b) sites[i].campaign->blocks[b].stream = streams[i][b];
}

}  // namespace talus
