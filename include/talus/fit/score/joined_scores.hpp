#pragma once
#include "talus/fit/score/score.hpp"

namespace talus {

/// The score of one of several campaigns.
struct SiteScore {
  std::string site;  ///< its name; empty: the names of its groups stay as they are
  Score score;
  std::size_t blocks = 0;  ///< of the campaign, scored or not
};

/// Scores of several campaigns as one: the groups of all ("authume: stop"), their blocks numbered on from campaign to
/// campaign, the total the weighted mean over all groups. One score alone stays as it is.
Score joined_scores(std::span<const SiteScore> scores);

}  // namespace talus
