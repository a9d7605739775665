#pragma once
#include <algorithm>
#include <span>
#include <string>

#include "talus/fit/campaign/observe.hpp"
#include "talus/fit/score/score.hpp"

namespace talus {

/// 0 if half of the trials of a block leave the terrain, 1 if all do.
inline double most_gone(const BlockRuns& runs) {
  const double left = runs.ends[static_cast<std::size_t>(End::Left)];
  return std::max(0.0, 2.0 * left / runs.trials - 1.0);
}

/// Takes the rows of a score, group by group.
class ScoreRows {
 public:
  /// @param runs  by block; their trials that were cut short are a penalty to each row. Empty: there are none
  explicit ScoreRows(std::span<const BlockRuns> runs) : runs_(runs) {}

  void add(std::uint32_t block, double score, bool unseen = false) {
    const auto group = static_cast<std::uint32_t>(score_.groups.size());
    rows_.push_back({group, block, score + kCutShort * cut_short(block), unseen});
  }

  bool empty() const { return score_.groups.empty(); }

  /// Ends a group; with too few rows it is left out.
  void close(const std::string& name) {
    if (rows_.size() >= kFewestRows) {
      double sum = 0.0;
      for (const RowScore& r : rows_) sum += r.score;
      score_.groups.push_back(
          {name, sum / static_cast<double>(rows_.size()), static_cast<std::uint32_t>(rows_.size())});
      score_.groups.back().unseen = static_cast<std::uint32_t>(std::ranges::count(rows_, true, &RowScore::unseen));
      score_.rows.insert(score_.rows.end(), rows_.begin(), rows_.end());
    }
    rows_.clear();
  }

  /// The mean over the groups, and the share of the trials of the asked blocks that did not end in a search.
  Score result(const std::vector<bool>& ask) {
    double cut = 0.0, blocks = 0.0;
    score_.total = mean_over(score_.groups);
    for (std::uint32_t b = 0; b < ask.size(); ++b)
      if (ask[b]) cut += cut_short(b), blocks += 1.0;
    if (blocks > 0.0) score_.cut_short = cut / blocks;
    return std::move(score_);
  }

 private:
  double cut_short(std::uint32_t block) const {
    return runs_.empty() || runs_[block].cut_short == 0
               ? 0.0
               : static_cast<double>(runs_[block].cut_short) / static_cast<double>(runs_[block].trials);
  }

  std::span<const BlockRuns> runs_;
  std::vector<RowScore> rows_;  // of the group under way
  Score score_;
};

}  // namespace talus
