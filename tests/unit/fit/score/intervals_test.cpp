#include "talus/fit/score/intervals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <set>

#include "support/campaigns.hpp"
#include "talus/fit/score/bootstrap.hpp"

namespace talus::test {
namespace {

std::vector<std::uint32_t> numbers_to(std::uint32_t n) {
  std::vector<std::uint32_t> list(n);
  for (std::uint32_t i = 0; i < n; ++i) list[i] = 1000 * i;
  return list;
}

/// The textbook's interval of a mean: 1, 2, 3, 4, 5 have the standard error sqrt(2.5 / 5), t of 4 degrees of freedom is
/// 2.776445.
TEST(Intervals, OfAMeanIsTheTextbooks) {
  const ScoreIntervals i = score_intervals(score_of_rows({1.0, 2.0, 3.0, 4.0, 5.0}), numbers_to(5));
  EXPECT_NEAR(i.total.low, 3.0 - 2.776445 * std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(i.total.high, 3.0 + 2.776445 * std::sqrt(0.5), 1e-6);
  EXPECT_EQ(i.groups[0].low, i.total.low);
}

/// Blocks of one cluster that say the same are as one block: three clusters of one value each give the interval of
/// these three values, t of 2 degrees of freedom 4.302653.
TEST(Intervals, BlocksOfAClusterCountOnce) {
  std::vector<double> values;
  std::vector<std::uint32_t> clusters;
  for (const double v : {1.0, 2.0, 6.0})
    for (int k = 0; k < 10; ++k) values.push_back(v), clusters.push_back(static_cast<std::uint32_t>(7.0 * v));
  const Interval i = score_intervals(score_of_rows(values), clusters).total;
  EXPECT_NEAR(i.high - i.low, 2.0 * 4.302653 * std::sqrt(7.0 / 3.0), 1e-5);  // variance 7
  const Score s = score_of_rows(values);
  EXPECT_EQ(used_clusters(s, clusters).count, 3U);
  EXPECT_TRUE(used_clusters(s, clusters).given);
  clusters.assign(30, 5);
  EXPECT_EQ(used_clusters(s, clusters).count, 30U) << "one cluster shows no scatter: each block is its own";
  EXPECT_FALSE(used_clusters(s, clusters).given);
}

/// Two sites, each with a group of scores: at one the blocks have no group, at the other three groups of two equal
/// blocks. The mean of the two means has half their standard deviations: variances 2.5 / 5 and 7 / 3 over 4, on 4 and 2
/// degrees of freedom (Satterthwaite: (0.125 + 0.583333)^2 / (0.125^2 / 4 + 0.583333^2 / 2) = 2.883).
TEST(Intervals, OfTwoSitesAddTheirVariances) {
  Score s = score_of_rows({1.0, 2.0, 3.0, 4.0, 5.0});
  s.groups.push_back(s.groups[0]);
  std::uint32_t block = 5;
  for (const double v : {1.0, 1.0, 2.0, 2.0, 6.0, 6.0}) s.rows.push_back({1, block++, v});
  const std::vector<std::uint32_t> clusters{77, 77, 77, 77, 77, 1, 1, 2, 2, 3, 3};  // of the first site: one group
  const ScoreIntervals i = score_intervals(s, clusters);
  EXPECT_NEAR(0.5 * (i.total.low + i.total.high), 3.0, 1e-12);
  const boost::math::students_t t(0.708333333 * 0.708333333 / (0.125 * 0.125 / 4.0 + 0.583333333 * 0.583333333 / 2.0));
  EXPECT_NEAR(0.5 * (i.total.high - i.total.low), boost::math::quantile(t, 0.975) * std::sqrt(0.708333333), 1e-6);
  EXPECT_NEAR(i.groups[0].high - i.groups[0].low, 2.0 * 2.776445 * std::sqrt(0.5), 1e-5);  // each on its own freedom
  EXPECT_NEAR(i.groups[1].high - i.groups[1].low, 2.0 * 4.302653 * std::sqrt(7.0 / 3.0), 1e-5);
  EXPECT_EQ(used_clusters(s, clusters).by_block, std::vector<std::string>{s.groups[0].name});
}

/// Ten clusters of eight blocks; a second observable is read in only k of them. Its own interval covers as often as it
/// says (with the freedom of all ten: 0, 80 and 88 % for k = 1, 2, 3).
TEST(Intervals, OfAnObservableSeenInFewClustersCover) {
  constexpr int kSets = 2000, kClusters = 10, kBlocks = 8;
  for (const int k : {1, 2, 3, 5}) {
    Numbers numbers(40 + static_cast<std::uint64_t>(k));
    const double common = k < 3 ? 0.0 : 0.5;  // by block the interval cannot know of a common part
    int covered = 0;
    for (int set = 0; set < kSets; ++set) {
      std::vector<double> values;
      std::vector<std::uint32_t> clusters;
      for (int c = 0; c < kClusters; ++c)
        for (int b = 0; b < kBlocks; ++b) values.push_back(1.0), clusters.push_back(static_cast<std::uint32_t>(c));
      Score s = score_of_rows(values);
      s.groups.push_back(s.groups[0]);
      for (int c = 0; c < k; ++c) {
        const double shared = common * numbers.normal();
        for (int b = 0; b < kBlocks; ++b)
          s.rows.push_back({1, static_cast<std::uint32_t>(c * kBlocks + b), 2.0 + shared + numbers.normal()});
      }
      const Interval i = score_intervals(s, clusters).groups[1];
      covered += i.low <= 2.0 && 2.0 <= i.high ? 1 : 0;
    }
    EXPECT_GE(covered / static_cast<double>(kSets), 0.93) << k;
    EXPECT_LE(covered / static_cast<double>(kSets), 0.97) << k;
  }
}

/// Blocks of one group are drawn together where the fitting rows have six groups; of five each block is drawn by
/// itself. Groups of one name at two sites are two.
TEST(BootstrapStreams, AreOfGroupsWhereThereAreSix) {
  Campaign c;
  for (std::uint32_t b = 0; b < 14; ++b) {
    MeasuredBlock& block = c.blocks.emplace_back();
    block.stream = stream_of_name("b" + std::to_string(b));
    block.group = "g" + std::to_string(b % 7);
    block.holdout = b % 7 == 6;
  }
  std::vector<std::uint32_t> streams = bootstrap_streams(c);
  for (std::size_t b = 0; b < 7; ++b) EXPECT_EQ(streams[b], streams[b + 7]);
  EXPECT_EQ(std::set(streams.begin(), streams.end()).size(), 7U);
  const std::vector<std::uint32_t> other = bootstrap_streams(c, "north");
  EXPECT_EQ(other[0], other[7]);
  EXPECT_NE(other[0], streams[0]);
  c.blocks[0].holdout = c.blocks[7].holdout = true;
  EXPECT_EQ(bootstrap_streams(c), streams_of(c));
}

/// The order of the rows and the names of the clusters change nothing.
TEST(Intervals, ArePermutationInvariant) {
  Score before = score_of_rows({3.0, 1.0, 4.0, 1.5, 5.0, 9.0}), after = score_of_rows({2.0, 1.5, 3.0, 1.0, 5.5, 7.0});
  const Reduction r = reduction(before, after, std::vector<std::uint32_t>{1, 1, 2, 2, 3, 3});
  std::ranges::reverse(before.rows);
  std::ranges::reverse(after.rows);
  const Reduction other = reduction(before, after, std::vector<std::uint32_t>{9, 9, 4, 4, 2, 2});
  EXPECT_NEAR(r.share, 1.0 - 20.0 / 23.5, 1e-15);
  EXPECT_NEAR(other.interval.low, r.interval.low, 1e-14);
  EXPECT_NEAR(other.interval.high, r.interval.high, 1e-14);
}

TEST(Intervals, NatsGainedArePerBlock) {
  Score before = score_of_rows({3.0, 1.0, 4.0}), after = score_of_rows({2.0, 1.0, 2.0});
  before.groups.push_back(before.groups[0]), after.groups.push_back(after.groups[0]);
  before.rows.push_back({1, 0, 5.0}), after.rows.push_back({1, 0, 2.0});  // the first block again, in another group
  EXPECT_NEAR(nats_gained(before, after, numbers_to(3)).per_block, (1.0 + 3.0 + 0.0 + 2.0) / 3.0, 1e-15);
}

/// Two models whose scores come from a known distribution: before skewed (gamma), the difference a share of it with a
/// scatter, and a part that all blocks of a cluster have in common.
struct KnownScores {
  std::size_t clusters, blocks_of_each;
  double common;

  void draw(Numbers& numbers, std::vector<double>& before, std::vector<double>& after) const {
    before.clear(), after.clear();
    for (std::size_t c = 0; c < clusters; ++c) {
      const double shared = common * numbers.normal();
      for (std::size_t i = 0; i < blocks_of_each; ++i) {
        const double b = -0.375 * std::log(numbers.uniform(1e-12, 1.0) * numbers.uniform(1e-12, 1.0));  // mean 0.75
        before.push_back(b);
        after.push_back(b * (0.9 - 0.3 * numbers.normal()) - shared);  // mean 0.675
      }
    }
  }
};

double share_covered(const KnownScores& known, std::uint64_t seed) {
  constexpr int kSets = 2000;
  Numbers numbers(seed);
  std::vector<double> before, after;
  std::vector<std::uint32_t> clusters;
  for (std::uint32_t c = 0; c < known.clusters; ++c) clusters.insert(clusters.end(), known.blocks_of_each, c);
  int covered = 0;
  for (int set = 0; set < kSets; ++set) {
    known.draw(numbers, before, after);
    const Interval i = reduction(score_of_rows(before), score_of_rows(after), clusters).interval;
    covered += i.low <= 0.1 && 0.1 <= i.high ? 1 : 0;
  }
  return covered / static_cast<double>(kSets);
}

/// 93 to 97 % within five standard errors of 2000 sets (0.5 % each): a normal quantile in place of t, or blocks of a
/// group taken as independent, fall out of it at 24 blocks.
TEST(Intervals, CoverAsOftenAsTheySay) {
  for (const std::size_t n : {24U, 50U, 100U}) {
    const double alone = share_covered({n, 1, 0.0}, n), grouped = share_covered({n / 2, 2, 0.15}, 1000 + n);
    RecordProperty("alone_" + std::to_string(n), std::to_string(alone));
    std::printf("coverage at %zu blocks: %.1f %% of independent ones, %.1f %% of pairs\n", n, 100.0 * alone,
                100.0 * grouped);
    for (const double share : {alone, grouped}) {
      EXPECT_GE(share, 0.93) << n;
      EXPECT_LE(share, 0.97) << n;
    }
  }
}

}  // namespace
}  // namespace talus::test
