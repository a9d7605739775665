#include "talus/fit/score/coverage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "support/campaigns.hpp"
#include "talus/fit/score/tail.hpp"

namespace talus::test {
namespace {

/// A measured value from the distribution of the simulated ones is as likely below each percentile as its name says,
/// whatever their number: with many ties, too. Five standard errors.
TEST(RandomRank, IsUniformForAMeasurementOfTheModel) {
  Numbers numbers(21);
  constexpr double kDraws = 40'000.0;
  for (const std::size_t n : {10U, 23U}) {
    for (const bool ties : {false, true}) {
      std::vector<double> x(n);
      const auto draw = [&] { return ties ? std::floor(3.0 * numbers.uniform(0.0, 1.0)) : numbers.normal(); };
      std::array<double, 3> below{};
      for (double k = 0.0; k < kDraws; k += 1.0) {
        for (double& value : x) value = draw();
        const double rank = random_rank(x, draw(), numbers.uniform(0.0, 1.0));
        ASSERT_TRUE(rank > 0.0 && rank < 1.0);
        for (std::size_t i = 0; i < 3; ++i) below[i] += rank < kCoverageShares[i] ? 1.0 / kDraws : 0.0;
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const double p = kCoverageShares[i];
        EXPECT_NEAR(below[i], p, 5.0 * std::sqrt(p * (1.0 - p) / kDraws)) << n << ties;
      }
    }
  }
}

/// Blocks that one model measured, each with its simulated values.
class CoverageOf : public testing::Test {
 protected:
  static constexpr std::size_t kBlocks = 120;
  CoverageOf() : campaign_(campaign_on_slope(kBlocks)) {
    measure(campaign_, model_of_slope(), 5);
    for (MeasuredBlock& b : campaign_.blocks) b.holdout = false;
    runs_ = observe(campaign_, model_of_slope(), {60, 1, 0, 0, {}, {}});
    all_.assign(kBlocks, true);
  }

  /// Moves every simulated run-out to `middle + factor (run-out - middle)`, seen from the place of release.
  void stretch(double factor) {
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const MeasuredBlock& block = campaign_.blocks[b];
      const std::vector<double> runouts = runouts_of(campaign_, block, runs_[b]);
      double middle = 0.0, count = 0.0;
      for (const double r : runouts)
        if (!std::isnan(r)) middle += r, count += 1.0;
      middle /= count;
      for (std::size_t t = 0; t < runouts.size(); ++t) {
        const double share = (middle + factor * (runouts[t] - middle)) / runouts[t];
        runs_[b].x[t] = block.x + share * (runs_[b].x[t] - block.x);
        runs_[b].y[t] = block.y + share * (runs_[b].y[t] - block.y);
      }
    }
  }

  Campaign campaign_;
  std::vector<BlockRuns> runs_;
  std::vector<bool> all_;
};

TEST_F(CoverageOf, ARightModelIsNotSaidToBeWrong) {
  const std::vector<Coverage> list = coverage(campaign_, runs_, all_);
  ASSERT_EQ(list.front().observable, "runout");
  ASSERT_EQ(list.size(), 4U);  // and speed, jump, spin of the screen
  for (const Coverage& c : list) {
    EXPECT_GE(c.rows, 60U);
    EXPECT_EQ(std::accumulate(c.ranks.begin(), c.ranks.end(), 0U), c.rows);
    for (const ShareBelow& below : c.below) {
      EXPECT_GT(below.corrected, kWrongSpread) << c.observable << ' ' << below.count;
      EXPECT_GE(below.corrected, below.p_value);
    }
  }
}

/// Of values that hardly scatter every measurement lies on one side.
TEST_F(CoverageOf, TooLittleScatterShowsAtBothEnds) {
  stretch(1e-3);
  const Coverage c = coverage(campaign_, runs_, all_).front();
  EXPECT_GT(c.below[0].count + c.rows - c.below[2].count, 0.95 * c.rows);
  EXPECT_NEAR(c.share(0), 0.5, 0.25);  // seen from the mean
  EXPECT_LT(c.below[0].corrected, kWrongSpread);
  EXPECT_LT(c.below[2].corrected, kWrongSpread);
  EXPECT_GT(c.ranks.front() + c.ranks.back(), 0.95 * c.rows);
}

TEST_F(CoverageOf, TooMuchScatterLeavesTheEndsEmpty) {
  stretch(3.0);
  const Coverage c = coverage(campaign_, runs_, all_).front();
  EXPECT_LT(c.ranks.front() + c.ranks.back(), kBlocks / 12);
  EXPECT_LT(std::min(c.below[0].p_value, c.below[2].p_value), 0.05);
}

/// Of 20 rows none lies below P5 with a probability of 0.95^20 = 0.358, one or none 0.736; three or more 0.0755, so
/// that counts of 0 to 3 hold 95 % (0.984).
TEST(CoverageTest, IsTheExactBinomialOne) {
  Campaign c = campaign_on_slope(20);
  std::vector<BlockRuns> runs(20);
  for (std::size_t b = 0; b < 20; ++b) {
    c.blocks[b].holdout = false;
    c.blocks[b].stop = Eigen::Vector2d(c.blocks[b].x + (b < 3 ? 1.0 : 60.0), c.blocks[b].y);  // three before all others
    runs[b].trials = 50;
    runs[b].screens.resize(1);
    for (int t = 0; t < 50; ++t) {
      runs[b].x.push_back(c.blocks[b].x + 35.0 + t);
      runs[b].y.push_back(c.blocks[b].y);
    }
  }
  const Coverage coverage_of = coverage(c, runs, std::vector<bool>(20, true)).front();
  EXPECT_EQ(coverage_of.below[0].count, 3U);
  EXPECT_NEAR(coverage_of.below[0].p_value, 2.0 * 0.07548367, 1e-7);
  EXPECT_EQ(coverage_of.below[0].expected.low, 0.0);
  EXPECT_EQ(coverage_of.below[0].expected.high, 3.0);
  EXPECT_EQ(coverage_of.below[1].expected.low, 6.0);  // P(X <= 5) = 0.0207, P(X <= 6) = 0.0577
  EXPECT_EQ(coverage_of.below[1].expected.high, 14.0);
  EXPECT_EQ(coverage_of.below[2].expected.low, 17.0);  // as below P5 from the other end: 3 of 20 beyond
  EXPECT_EQ(coverage_of.below[2].count, 20U);
  EXPECT_NEAR(coverage_of.below[2].p_value, 2.0 * 0.35848592, 1e-7);
}

/// All blocks came to rest; the DEM of the model ends where 80 % of the trials of a block have stopped. What left went
/// farther: no rank below that of the end changes. Where a block may have left, too, only those that stay are compared.
TEST_F(CoverageOf, TrialsThatLeftWentFarther) {
  const Coverage whole = coverage(campaign_, runs_, all_).front();
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::vector<double> runouts = runouts_of(campaign_, campaign_.blocks[b], runs_[b]);
    std::vector<double> sorted = runouts;
    std::ranges::sort(sorted);
    for (std::size_t t = 0; t < runouts.size(); ++t)
      if (runouts[t] > sorted[48]) {
        runs_[b].x[t] = runs_[b].y[t] = kNotGiven;
        ++runs_[b].ends[static_cast<std::size_t>(End::Left)];
      }
  }
  const Coverage cut = coverage(campaign_, runs_, all_).front();
  EXPECT_EQ(cut.rows, whole.rows);
  for (const std::size_t share : {0U, 1U}) EXPECT_EQ(cut.below[share].count, whole.below[share].count);
  for (std::size_t rank = 0; rank < 7; ++rank) EXPECT_EQ(cut.ranks[rank], whole.ranks[rank]);
  campaign_.blocks[0].stop.reset();
  EXPECT_LT(coverage(campaign_, runs_, all_).front().below[1].count + 5, whole.below[1].count);
}

/// Trials of 24 blocks: 60 of 200 leave. Without a missing block all stay, (1 - 60/201)^24. A missing block leaves
/// with 61/201, and at most one does.
TEST(Leaving, IsTheProbabilityThatSoFewLeave) {
  Campaign c = campaign_on_slope(24);
  std::vector<BlockRuns> runs(24);
  for (std::size_t b = 0; b < 24; ++b) {
    c.blocks[b].stop = Eigen::Vector2d::Zero();
    runs[b].trials = 200;
    runs[b].ends[static_cast<std::size_t>(End::Left)] = 60;
  }
  std::vector<bool> ask(24, true);
  const double q = 60.0 / 201.0, r = 61.0 / 201.0;
  const LeavingTest none = leaving_test(c, runs, ask);
  EXPECT_NEAR(none.p_value, std::pow(1.0 - q, 24), 1e-15);
  EXPECT_NEAR(none.expected, 7.2, 1e-12);
  EXPECT_NEAR(none.p_if_all_left, 1.0, 1e-12);
  c.blocks[7].stop.reset();
  const LeavingTest one = leaving_test(c, runs, ask);
  EXPECT_EQ(one.missing, 1U);
  EXPECT_NEAR(one.p_value, std::pow(1.0 - q, 23) + 23.0 * q * std::pow(1.0 - q, 22) * (1.0 - r), 1e-15);
  EXPECT_NEAR(one.p_if_all_left, 1.0 - std::pow(1.0 - q, 23) * (1.0 - r), 1e-12);
  for (std::size_t b = 0; b < 24; ++b) c.blocks[b].stop.reset();
  EXPECT_NEAR(leaving_test(c, runs, ask).p_value, 1.0, 1e-12);  // all may have left
  EXPECT_NEAR(leaving_test(c, runs, ask).p_if_all_left / std::pow(r, 24), 1.0, 1e-9);
  std::fill(ask.begin() + 4, ask.end(), false);
  EXPECT_TRUE(std::isnan(leaving_test(c, runs, ask).p_value));
}

/// Measured blocks are trajectories of the model themselves: the share of the campaigns with p <= 0.05 is at most 0.05,
/// and where half of the blocks that stayed were not found it is smaller.
TEST(Leaving, OfARightModelIsSeldomRare) {
  constexpr std::uint32_t kBlocks = 20, kTrials = 30, kSets = 4000;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform;
  Campaign c = campaign_on_slope(kBlocks);
  std::vector<BlockRuns> runs(kBlocks);
  std::array<int, 2> rare{};
  int rare_if_all_left = 0;
  for (std::uint32_t set = 0; set < kSets; ++set)
    for (const bool unfound : {false, true}) {
      for (std::uint32_t b = 0; b < kBlocks; ++b) {
        const double p = 0.02 * (b + 1);
        runs[b].trials = kTrials;
        runs[b].ends[static_cast<std::size_t>(End::Left)] =
            std::binomial_distribution<std::uint32_t>(kTrials, p)(random);
        c.blocks[b].stop = Eigen::Vector2d::Zero();
        if (uniform(random) < p || (unfound && uniform(random) < 0.5)) c.blocks[b].stop.reset();
      }
      const LeavingTest test = leaving_test(c, runs, std::vector<bool>(kBlocks, true));
      rare[unfound] += test.p_value <= 0.05 ? 1 : 0;
      rare_if_all_left += !unfound && test.p_if_all_left <= 0.05 ? 1 : 0;
    }
  EXPECT_LE(rare[0], 0.05 * kSets + 3.0 * std::sqrt(0.05 * 0.95 * kSets));
  EXPECT_GE(rare[0], 0.02 * kSets);  // counts are coarse: not much less than 5 %
  EXPECT_LT(rare[1], 0.01 * kSets);
  EXPECT_LE(rare_if_all_left, 0.05 * kSets + 3.0 * std::sqrt(0.05 * 0.95 * kSets));
  EXPECT_GE(rare_if_all_left, 0.02 * kSets);
}

/// A block of which too few trials stopped has no rank.
TEST_F(CoverageOf, ABlockWithFewValuesIsLeftOut) {
  std::fill_n(runs_[3].x.begin(), 51, kNotGiven);
  const Coverage whole = coverage(campaign_, observe(campaign_, model_of_slope(), {60, 1, 0, 0, {}, {}}), all_).front();
  const Coverage c = coverage(campaign_, runs_, all_).front();
  EXPECT_EQ(c.rows, whole.rows - 1);
  EXPECT_EQ(c.unseen, whole.unseen + 1);
}

/// The tail of a climatology: with leave-one-out the mean fair score is half of the mean distance of two values, cut
/// off at the median.
TEST_F(CoverageOf, TailOfTheClimatologyIsHalfOfTheMeanDistance) {
  std::vector<double> far;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (b.stop) far.push_back(std::max(runout_of(campaign_, b), tail_begin(campaign_)));
  double distance = 0.0, mean = 0.0, square = 0.0;
  const auto n = static_cast<double>(far.size());
  for (const double a : far) {
    for (const double b : far) distance += std::abs(a - b) / (n * (n - 1.0));
    mean += a / n;
  }
  for (const double a : far) square += (a - mean) * (a - mean) / n;
  const Score tail = tail_score_of_climatology(campaign_, all_);
  EXPECT_EQ(tail.rows.size(), far.size());
  EXPECT_NEAR(tail.total, 0.5 * distance / std::sqrt(square), 1e-12);
  EXPECT_LT(tail_score(campaign_, runs_, all_).total, 0.9);
}

/// Runs whose far stops are pulled back miss the tail and nothing else.
TEST_F(CoverageOf, AModelThatStopsShortIsWrongInTheTail) {
  const double before = tail_score(campaign_, runs_, all_).total;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const MeasuredBlock& block = campaign_.blocks[b];
    const std::vector<double> runouts = runouts_of(campaign_, block, runs_[b]);
    for (std::size_t t = 0; t < runouts.size(); ++t) {
      const double share = std::min(1.0, tail_begin(campaign_) / runouts[t]);
      runs_[b].x[t] = block.x + share * (runs_[b].x[t] - block.x);
      runs_[b].y[t] = block.y + share * (runs_[b].y[t] - block.y);
    }
  }
  // All values are at the threshold then: the score is the mean distance of the measured ones from it.
  double expected = 0.0, mean = 0.0, square = 0.0, n = 0.0;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (b.stop) expected += std::max(0.0, runout_of(campaign_, b) - tail_begin(campaign_)), n += 1.0;
  mean = expected / n;
  for (const MeasuredBlock& b : campaign_.blocks)
    if (b.stop) square += std::pow(std::max(0.0, runout_of(campaign_, b) - tail_begin(campaign_)) - mean, 2) / n;
  EXPECT_NEAR(tail_score(campaign_, runs_, all_).total, mean / std::sqrt(square), 1e-9);
  EXPECT_GT(mean / std::sqrt(square), before);
}

}  // namespace
}  // namespace talus::test
