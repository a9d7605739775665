#include "talus/fit/score/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "talus/base/expect.hpp"
#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/score/intervals.hpp"

namespace talus {
namespace {

constexpr std::size_t kFewestDrawn = 6;  // groups of blocks whose choice a bootstrap can vary
constexpr std::uint64_t kDifferenceSeed = 1;

/// The weighted mean of each group; NaN for one of no weight.
std::vector<double> weighted_groups(const Score& score, std::span<const double> weight) {
  std::vector<double> sum(score.groups.size(), 0.0), total(score.groups.size(), 0.0);
  for (const RowScore& row : score.rows) {
    TALUS_EXPECT(row.group < sum.size() && row.block < weight.size(), "a row has a group and a block");
    sum[row.group] += weight[row.block] * row.score;
    total[row.group] += weight[row.block];
  }
  for (std::size_t g = 0; g < sum.size(); ++g) sum[g] = total[g] > 0.0 ? sum[g] / total[g] : kNotGiven;
  return sum;
}

Interval middle_of_known(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return middle_of(std::move(values));
}

}  // namespace

double weighted_total(const Score& score, std::span<const double> weight) {
  const std::vector<double> means = weighted_groups(score, weight);
  return mean_over(score.groups, [&](std::size_t g) { return means[g]; });
}

std::vector<std::uint32_t> bootstrap_streams(const Campaign& campaign, const std::string& site) {
  std::vector<std::uint32_t> groups = clusters_of(campaign);
  std::set<std::uint32_t> fitted;
  for (std::size_t b = 0; b < groups.size(); ++b)
    if (!campaign.blocks[b].holdout) fitted.insert(groups[b]);
  if (fitted.size() < kFewestDrawn) return streams_of(campaign);
  for (std::size_t b = 0; b < groups.size(); ++b)
    if (!site.empty() && !campaign.blocks[b].group.empty()) groups[b] ^= stream_of_name(site);
  return groups;
}

std::vector<double> bootstrap_weights(std::span<const std::uint32_t> streams, std::uint32_t draw, std::uint64_t seed) {
  std::vector<double> weight;
  weight.reserve(streams.size());
  for (const std::uint32_t stream : streams)
    weight.push_back(-natural_log(draw_of_block(seed, stream, draw, BlockDraw::Weight)));
  return weight;
}

Difference difference(const Score& before, const Score& after, std::span<const std::uint32_t> streams,
                      std::uint32_t draws) {
  Difference d{after.total - before.total, {}, {}};
  for (std::uint32_t draw = 0; draw < draws; ++draw) {
    const std::vector<double> weight = bootstrap_weights(streams, draw, kDifferenceSeed);
    d.draws.push_back(weighted_total(after, weight) - weighted_total(before, weight));
  }
  d.interval = middle_of_known(d.draws);
  return d;
}

Difference mean_difference(std::span<const Score> before, std::span<const Score> after,
                           std::span<const std::uint32_t> streams) {
  TALUS_EXPECT(!before.empty() && before.size() == after.size(), "scores in pairs");
  const double share = 1.0 / static_cast<double>(before.size());
  Difference mean;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Difference one = difference(before[i], after[i], streams);
    mean.draws.resize(one.draws.size(), 0.0);
    mean.mean += share * one.mean;
    for (std::size_t draw = 0; draw < one.draws.size(); ++draw) mean.draws[draw] += share * one.draws[draw];
  }
  mean.interval = middle_of_known(mean.draws);
  return mean;
}

}  // namespace talus
