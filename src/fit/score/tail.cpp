#include "talus/fit/score/tail.hpp"

#include <algorithm>
#include <cmath>

#include "fitting_values.hpp"
#include "talus/base/sample.hpp"
#include "talus/fit/campaign/deposits.hpp"
#include "talus/fit/score/fair_scores.hpp"

namespace talus {
namespace {

FittingValues<double> fitting_runouts(const Campaign& campaign) {
  FittingValues<double> fitting;
  for (std::uint32_t b = 0; b < campaign.blocks.size(); ++b)
    if (!campaign.blocks[b].holdout && campaign.blocks[b].stop) fitting.add(b, runout_of(campaign, campaign.blocks[b]));
  return fitting;
}

/// Run-outs of places anywhere in the region of a mapped block.
void runouts_anywhere(const Campaign& campaign, const MeasuredBlock& block, std::vector<double>& out) {
  out.clear();
  for (const Eigen::Vector2d& place : campaign.deposits->anywhere[region_at(*campaign.deposits, *block.stop)])
    if (const double distance = run_out(campaign, place).distance; !std::isnan(distance)) out.push_back(distance);
}

}  // namespace

double runout_of(const Campaign& campaign, const MeasuredBlock& block) {
  if (campaign.deposits != nullptr) return run_out(campaign, *block.stop).distance;
  return block.stop ? std::hypot(block.stop->x() - block.x, block.stop->y() - block.y) : kNotGiven;
}

std::vector<double> runouts_of(const Campaign& campaign, const MeasuredBlock& block, const BlockRuns& runs) {
  std::vector<double> values;
  values.reserve(runs.trials);
  for (std::uint32_t t = 0; t < runs.trials; ++t)
    values.push_back(campaign.deposits == nullptr ? std::hypot(runs.x[t] - block.x, runs.y[t] - block.y)
                                                  : run_out(campaign, {runs.x[t], runs.y[t]}).distance);
  return values;
}

double tail_begin(const Campaign& campaign) {
  return median_of(fitting_runouts(campaign).values);
}

Score tail_score(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                 std::span<const std::uint32_t> folds) {
  const FittingValues<double> fitting = fitting_runouts(campaign);
  if (fitting.size() < kFewestRows) return {};
  const double begin = median_of(fitting.values);
  std::vector<double> beyond = fitting.values, values;
  for (double& value : beyond) value = std::max(value, begin);
  const double spread = std::sqrt(variance_of(beyond));
  if (!(spread > 0.0)) return {};
  Score out;
  GroupScore group{"runout tail", 0.0, 0};
  for (std::uint32_t b = 0; b < campaign.blocks.size(); ++b) {
    const MeasuredBlock& block = campaign.blocks[b];
    if (!ask[b] || !block.stop) continue;
    if (!runs.empty())
      keep_finite(runouts_of(campaign, block, runs[b]), values);
    else if (campaign.deposits == nullptr)
      fitting.of_others(b, values, folds);
    else
      runouts_anywhere(campaign, block, values);
    const bool unseen = !runs.empty() && values.size() < kFewestSimulated;
    if (unseen && campaign.deposits != nullptr)
      runouts_anywhere(campaign, block, values);
    else if (unseen)
      fitting.of_others(b, values, folds);
    const double score = fair_tail_crps(values, runout_of(campaign, block), begin) / spread;
    out.rows.push_back({0, b, score, unseen});
    group.score += score;
    group.unseen += unseen ? 1 : 0;
    ++group.rows;
  }
  if (group.rows < kFewestRows) return {};
  out.total = group.score /= group.rows;
  out.groups.push_back(std::move(group));
  return out;
}

Score tail_score_of_climatology(const Campaign& campaign, const std::vector<bool>& ask,
                                std::span<const std::uint32_t> folds) {
  return tail_score(campaign, {}, ask, folds);
}

}  // namespace talus
