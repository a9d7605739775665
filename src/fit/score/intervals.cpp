#include "talus/fit/score/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <set>

#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr double kConfidence = 0.95;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The clusters of the rows of a score, numbered from zero in the order of their numbers.
struct Numbering {
  std::vector<std::size_t> of_row;
  std::size_t count = 0;
  bool given = true;

  Numbering(const Score& score, std::span<const std::uint32_t> clusters) {
    number(score, [&](const RowScore& row) { return clusters[row.block]; });
    given = count >= kFewestClusters;
    if (!given) number(score, [](const RowScore& row) { return row.block; });
  }

 private:
  void number(const Score& score, const std::function<std::uint32_t(const RowScore&)>& of) {
    std::set<std::uint32_t> names;
    for (const RowScore& row : score.rows) names.insert(of(row));
    const std::vector<std::uint32_t> list(names.begin(), names.end());
    of_row.clear();
    for (const RowScore& row : score.rows)
      of_row.push_back(static_cast<std::size_t>(std::ranges::lower_bound(list, of(row)) - list.begin()));
    count = list.size();
  }
};

/// Sums of the rows of a score by group and cluster: what is left without a cluster costs no pass over the rows.
class Sums {
 public:
  Sums(const Score& score, const Numbering& clusters) : score_(score), groups_(score.groups.size()) {
    const std::size_t cells = groups_ * clusters.count;
    sum_.assign(cells, 0.0);
    rows_.assign(cells, 0.0);
    whole_.assign(groups_, 0.0);
    whole_rows_.assign(groups_, 0.0);
    for (std::size_t r = 0; r < score.rows.size(); ++r) {
      const std::size_t group = score.rows[r].group, cell = clusters.of_row[r] * groups_ + group;
      sum_[cell] += score.rows[r].score, rows_[cell] += 1.0;
      whole_[group] += score.rows[r].score, whole_rows_[group] += 1.0;
    }
  }

  /// Mean of a group without a cluster. The mean of all where nothing else is left: one cluster shows no scatter.
  double group(std::size_t group, std::size_t without) const {
    const double all = whole_[group] / whole_rows_[group];
    if (without == kNone) return all;
    const std::size_t cell = without * groups_ + group;
    const double left = whole_rows_[group] - rows_[cell];
    return left > 0.0 ? (whole_[group] - sum_[cell]) / left : all;
  }
  double total(std::size_t without) const {
    double sum = 0.0, weights = 0.0;
    for (std::size_t g = 0; g < groups_; ++g)
      sum += score_.groups[g].weight * group(g, without), weights += score_.groups[g].weight;
    return weights > 0.0 ? sum / weights : kNotGiven;
  }

 private:
  const Score& score_;
  std::size_t groups_;
  std::vector<double> sum_, rows_, whole_, whole_rows_;  // by cluster and group; by group
};

/// @param without  the estimate without a cluster; of kNone: the estimate itself
Interval jackknife(std::size_t clusters, const std::function<double(std::size_t)>& without) {
  const double estimate = without(kNone);
  if (clusters < kFewestClusters || std::isnan(estimate)) return {};
  const auto n = static_cast<double>(clusters);
  double squares = 0.0;
  for (std::size_t c = 0; c < clusters; ++c) squares += std::pow(without(c) - estimate, 2);
  const boost::math::students_t t(n - 1.0);
  const double reach = boost::math::quantile(t, 0.5 + 0.5 * kConfidence) * std::sqrt((n - 1.0) / n * squares);
  return {estimate - reach, estimate + reach};
}

void expect_same_rows(const Score& before, const Score& after) {
  TALUS_EXPECT(before.rows.size() == after.rows.size() && before.groups.size() == after.groups.size(),
               "two scores are compared on the same rows");
}

}  // namespace

std::vector<std::uint32_t> clusters_of(const Campaign& campaign) {
  std::vector<std::uint32_t> clusters;
  for (const MeasuredBlock& block : campaign.blocks)
    clusters.push_back(block.group.empty() ? block.stream : stream_of_name("group " + block.group));
  return clusters;
}

UsedClusters used_clusters(const Score& score, std::span<const std::uint32_t> clusters) {
  const Numbering numbering(score, clusters);
  return {numbering.count, numbering.given};
}

ScoreIntervals score_intervals(const Score& score, std::span<const std::uint32_t> clusters) {
  const Numbering numbering(score, clusters);
  const Sums sums(score, numbering);
  ScoreIntervals out;
  out.total = jackknife(numbering.count, [&](std::size_t c) { return sums.total(c); });
  for (std::size_t g = 0; g < score.groups.size(); ++g)
    out.groups.push_back(jackknife(numbering.count, [&](std::size_t c) { return sums.group(g, c); }));
  return out;
}

Reduction reduction(const Score& before, const Score& after, std::span<const std::uint32_t> clusters) {
  expect_same_rows(before, after);
  const Numbering numbering(before, clusters);
  const Sums old(before, numbering), now(after, numbering);
  const auto share = [&](std::size_t c) { return 1.0 - now.total(c) / old.total(c); };
  return {share(kNone), jackknife(numbering.count, share)};
}

NatsGained nats_gained(const Score& before, const Score& after, std::span<const std::uint32_t> clusters) {
  expect_same_rows(before, after);
  const Numbering numbering(before, clusters);
  std::vector<double> sum(numbering.count, 0.0);
  std::vector<std::set<std::uint32_t>> blocks(numbering.count);
  for (std::size_t r = 0; r < before.rows.size(); ++r) {
    sum[numbering.of_row[r]] += before.rows[r].score - after.rows[r].score;
    blocks[numbering.of_row[r]].insert(before.rows[r].block);
  }
  const auto mean = [&](std::size_t without) {
    double nats = 0.0, count = 0.0;
    for (std::size_t c = 0; c < sum.size(); ++c)
      if (c != without) nats += sum[c], count += static_cast<double>(blocks[c].size());
    return count > 0.0 ? nats / count : kNotGiven;
  };
  return {mean(kNone), jackknife(numbering.count, mean)};
}

}  // namespace talus
