#pragma once
#include <span>

#include "talus/fit/campaign/campaign.hpp"

namespace talus {

/// The rock of each of some blocks of a campaign, numbered from 0 in the order of these blocks. Which are of one rock
/// depends neither on their order nor on their ids.
///
/// Blocks with a name (MeasuredBlock::rock) are of one rock if they share it. The others are linked where mass and axes
/// are equal to 2 %, as of a rock that was weighed and measured again; blocks that are linked through others are of one
/// rock, too. A chain that is wider than 6 % cannot be one rock: it is linked again by half of the 2 %, and so on.
///
/// Error: two rocks of nearly one size count as one, which is safe and costs a test power; a rock that lost more than
/// 2 % between its releases counts as two. Source: docs/diagnosis-method.md, "Rocks".
std::vector<std::size_t> rocks_of(const Campaign& campaign, std::span<const std::size_t> blocks);

}  // namespace talus
