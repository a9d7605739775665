#include "talus/fit/score/joined_scores.hpp"

#include <algorithm>

namespace talus {

Score joined_scores(std::span<const SiteScore> scores) {
  if (scores.size() == 1 && scores.front().site.empty()) return scores.front().score;
  Score all;
  std::size_t blocks = 0;
  for (const SiteScore& one : scores) {
    const auto groups = static_cast<std::uint32_t>(all.groups.size());
    for (GroupScore group : one.score.groups) {
      if (!one.site.empty()) group.name = one.site + ": " + group.name;
      all.groups.push_back(std::move(group));
    }
    for (RowScore row : one.score.rows) {
      row.group += groups;
      row.block += static_cast<std::uint32_t>(blocks);
      all.rows.push_back(row);
    }
    blocks += one.blocks;
    all.cut_short = std::max(all.cut_short, one.score.cut_short);  // of the worst site
  }
  all.total = mean_over(all.groups);
  return all;
}

}  // namespace talus
