#pragma once
#include <string>
#include <vector>

#include "talus/fit/campaign/campaign.hpp"

namespace talus::io {

/// Where the tables of a campaign are; empty: not given.
struct CampaignFiles {
  std::string blocks, stops, passages, samples;
};

/// Reads blocks.csv and what was measured of them into a campaign that has its terrain and screens already.
/// Map coordinates become local ones by the campaign's grid. Throws InputError.
void read_tables(const CampaignFiles& files, Campaign& campaign, std::vector<std::string>& warnings);

}  // namespace talus::io
