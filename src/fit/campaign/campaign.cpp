#include "talus/fit/campaign/campaign.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

std::vector<bool> fitting_rows(const Campaign& campaign) {
  std::vector<bool> rows = holdout_rows(campaign);
  rows.flip();
  return rows;
}

std::vector<bool> holdout_rows(const Campaign& campaign) {
  std::vector<bool> rows;
  for (const MeasuredBlock& block : campaign.blocks) rows.push_back(block.holdout);
  return rows;
}

std::size_t count_of_rows(const std::vector<bool>& rows) {
  return static_cast<std::size_t>(std::ranges::count(rows, true));
}

bool all_at_rest(const Campaign& campaign, const std::vector<bool>& rows) {
  if (campaign.deposits != nullptr) return false;
  for (std::size_t b = 0; b < campaign.blocks.size(); ++b)
    if (rows[b] && !campaign.blocks[b].stop) return false;
  return true;
}

std::vector<std::uint32_t> streams_of(const Campaign& campaign) {
  std::vector<std::uint32_t> streams;
  for (const MeasuredBlock& block : campaign.blocks) streams.push_back(block.stream);
  return streams;
}

Block body_of(const MeasuredBlock& block) {
  return {equivalent_diameter(block.mass, block.density), block.mass, block.axes};
}

double equivalent_diameter(double mass, double density) {
  return std::cbrt(6.0 * mass / (kPi * density));
}

}  // namespace talus
