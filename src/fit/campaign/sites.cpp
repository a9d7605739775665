#include "talus/fit/campaign/sites.hpp"

#include <map>
#include <set>

namespace talus {

std::vector<std::vector<std::uint32_t>> streams_of_sites(std::span<const Site> sites) {
  std::map<std::uint32_t, std::set<std::size_t>> fitting, all;  // by stream: sites that have it
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (const MeasuredBlock& block : sites[i].campaign->blocks) {
      all[block.stream].insert(i);
      if (!block.holdout) fitting[block.stream].insert(i);
    }
  std::vector<std::vector<std::uint32_t>> streams;
  for (const Site& site : sites) {
    streams.emplace_back();
    for (const MeasuredBlock& block : site.campaign->blocks) {
      const bool elsewhere = (block.holdout ? all : fitting)[block.stream].size() > 1;  // held-out rows change no fit
      streams.back().push_back(elsewhere ? stream_of_name(site.name + "/" + block.id) : block.stream);
    }
  }
  return streams;
}

void give_own_streams(std::span<const Site> sites) {
  const std::vector<std::vector<std::uint32_t>> streams = streams_of_sites(sites);
  for (std::size_t i = 0; i < sites.size(); ++i)
    for (std::size_t b = 0; b < streams[i].size(); ++b) sites[i].campaign->blocks[b].stream = streams[i][b];
}

}  // namespace talus
