#pragma once
#include <span>
#include <string>
#include <vector>

#include "talus/fit/campaign/campaign.hpp"

namespace talus {

/// One of several campaigns that are fitted together. docs/several-campaigns.md.
struct Site {
  std::string name;  ///< of its own
  Campaign* campaign;
};

/// Random streams of the blocks of several campaigns: that of the block's id, as where the campaign stands alone. An id
/// that another campaign has too gets the stream of "SITE/ID", or blocks of two sites would have the same random
/// numbers.
///
/// @return by site and block; the order of the sites changes nothing
std::vector<std::vector<std::uint32_t>> streams_of_sites(std::span<const Site> sites);

/// Gives the blocks these streams.
void give_own_streams(std::span<const Site> sites);

}  // namespace talus
