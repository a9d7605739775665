#include "talus/fit/score/intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The clusters of the rows of a score, and the strata that they form: clusters that share a group of scores, if only
/// through others, are of one stratum.
struct Clusters {
  std::vector<std::size_t> of_row, stratum;  // by row; by cluster
  std::vector<bool> given;                   // by cluster; false: a block by itself
  std::vector<std::vector<std::size_t>> of_group;
  std::size_t count = 0, strata = 0;

  /// @param names  by block of the campaign. In a group of scores that fewer than three of them have rows in, each
  ///               block is by itself
  Clusters(const Score& score, std::span<const std::uint32_t> names) : of_group(score.groups.size()) {
    std::vector<std::set<std::uint32_t>> in_group(score.groups.size());
    for (const RowScore& row : score.rows) in_group[row.group].insert(names[row.block]);
    using Key = std::pair<bool, std::uint32_t>;
    const auto key_of = [&](const RowScore& row) {
      const bool known = in_group[row.group].size() >= kFewestClusters;
      return Key{known, known ? names[row.block] : row.block};
    };
    std::map<Key, std::size_t> number;
    for (const RowScore& row : score.rows) number.emplace(key_of(row), 0);
    for (auto& [key, index] : number) index = count++, given.push_back(key.first);
    std::vector<std::set<std::size_t>> members(score.groups.size());
    for (const RowScore& row : score.rows) {
      of_row.push_back(number.at(key_of(row)));
      members[row.group].insert(of_row.back());
    }
    for (std::size_t g = 0; g < members.size(); ++g) of_group[g].assign(members[g].begin(), members[g].end());
    join();
  }

 private:
  void join() {
    stratum.resize(count);
    std::iota(stratum.begin(), stratum.end(), std::size_t{0});
    for (const auto& members : of_group)
      for (const std::size_t member : members) {
        const std::size_t from = stratum[member], to = stratum[members.front()];
        if (from != to) std::ranges::replace(stratum, from, to);
      }
    std::vector<std::size_t> names = stratum;
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (std::size_t& s : stratum) s = static_cast<std::size_t>(std::ranges::lower_bound(names, s) - names.begin());
    strata = names.size();
  }
};

/// Sums of the rows of a score by group and cluster: what is left without a cluster costs no pass over the rows.
class Sums {
 public:
  Sums(const Score& score, const Clusters& clusters) : score_(score), groups_(score.groups.size()) {
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

  /// Mean of a group without a cluster; where nothing is left of a group without weight, the mean of all.
  double group(std::size_t group, std::size_t without) const {
    const double all = whole_[group] / whole_rows_[group];
    if (without == kNone) return all;
    const std::size_t cell = without * groups_ + group;
    const double left = whole_rows_[group] - rows_[cell];
    return left > 0.0 ? (whole_[group] - sum_[cell]) / left : all;
  }
  double total(std::size_t without) const {
    return mean_over(score_.groups, [&](std::size_t g) { return group(g, without); });
  }

 private:
  const Score& score_;
  std::size_t groups_;
  std::vector<double> sum_, rows_, whole_, whole_rows_;  // by cluster and group; by group
};

/// The jackknife in one stratum: its clusters, and the sum of the squares of what leaving out one of them changes.
struct Stratum {
  std::size_t clusters = 0;
  double squares = 0.0;

  double freedom() const { return static_cast<double>(clusters) - 1.0; }
  double variance() const { return freedom() / static_cast<double>(clusters) * squares; }
};

/// Student's interval of an estimate whose variance is the sum of those of strata; its degrees of freedom are
/// Satterthwaite's. None where a stratum that counts has too few clusters.
Interval interval_of(double estimate, std::span<const Stratum> strata) {
  double variance = 0.0, terms = 0.0;
  for (const Stratum& stratum : strata) {
    if (std::isnan(stratum.squares)) return {};
    if (stratum.clusters < kFewestClusters && (stratum.squares > 0.0 || strata.size() == 1)) return {};
    if (!(stratum.squares > 0.0)) continue;
    variance += stratum.variance();
    terms += stratum.variance() * stratum.variance() / stratum.freedom();
  }
  if (std::isnan(estimate)) return {};
  if (!(variance > 0.0)) return {estimate, estimate};
  const double freedom = strata.size() == 1 ? strata.front().freedom() : variance * variance / terms;
  const double reach =
      boost::math::quantile(boost::math::students_t(freedom), 0.5 + 0.5 * kConfidence) * std::sqrt(variance);
  return {estimate - reach, estimate + reach};
}

/// @param without  the estimate without a cluster; of kNone: the estimate itself
Interval jackknife(const Clusters& clusters, const std::function<double(std::size_t)>& without) {
  const double estimate = without(kNone);
  std::vector<Stratum> strata(clusters.strata);
  for (std::size_t c = 0; c < clusters.count; ++c) {
    Stratum& stratum = strata[clusters.stratum[c]];
    stratum.squares += std::pow(without(c) - estimate, 2);
    ++stratum.clusters;
  }
  return interval_of(estimate, strata);
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
  const Clusters used(score, clusters);
  const auto given = static_cast<std::size_t>(std::ranges::count(used.given, true));
  std::set<std::uint32_t> blocks;
  for (const RowScore& row : score.rows) blocks.insert(row.block);
  UsedClusters out{given > 0 ? given : used.count, blocks.size(), given > 0, {}};
  for (std::size_t g = 0; given > 0 && g < score.groups.size(); ++g)
    if (!used.of_group[g].empty() && !used.given[used.of_group[g].front()])
      out.by_block.push_back(score.groups[g].name);
  return out;
}

ScoreIntervals score_intervals(const Score& score, std::span<const std::uint32_t> clusters) {
  const Clusters used(score, clusters);
  const Sums sums(score, used);
  ScoreIntervals out;
  out.total = jackknife(used, [&](std::size_t c) { return sums.total(c); });
  for (std::size_t g = 0; g < score.groups.size(); ++g) {
    const double mean = sums.group(g, kNone);
    Stratum own;
    for (const std::size_t c : used.of_group[g]) ++own.clusters, own.squares += std::pow(sums.group(g, c) - mean, 2);
    out.groups.push_back(interval_of(mean, {&own, 1}));
  }
  return out;
}

Reduction reduction(const Score& before, const Score& after, std::span<const std::uint32_t> clusters) {
  expect_same_rows(before, after);
  const Clusters used(before, clusters);
  const Sums old(before, used), now(after, used);
  const auto share = [&](std::size_t c) { return 1.0 - now.total(c) / old.total(c); };
  return {share(kNone), jackknife(used, share)};
}

NatsGained nats_gained(const Score& before, const Score& after, std::span<const std::uint32_t> clusters) {
  expect_same_rows(before, after);
  const Clusters used(before, clusters);
  std::vector<double> sum(used.count, 0.0), blocks(used.count, 0.0);
  std::map<std::uint32_t, std::size_t> cluster_of;  // of a block: the given one where it has one
  for (std::size_t r = 0; r < before.rows.size(); ++r) {
    const std::size_t cluster = used.of_row[r];
    sum[cluster] += before.rows[r].score - after.rows[r].score;
    std::size_t& own = cluster_of.try_emplace(before.rows[r].block, cluster).first->second;
    own = std::max(own, cluster);  // given ones have the higher numbers
  }
  for (const auto& [block, cluster] : cluster_of) blocks[cluster] += 1.0;
  const auto mean = [&](std::size_t without) {
    double nats = 0.0, count = 0.0;
    for (std::size_t c = 0; c < sum.size(); ++c)
      if (c != without) nats += sum[c], count += blocks[c];
    return count > 0.0 ? nats / count : kNotGiven;
  };
  return {mean(kNone), jackknife(used, mean)};
}

}  // namespace talus
