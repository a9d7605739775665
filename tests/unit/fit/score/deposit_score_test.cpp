#include "talus/fit/score/deposit_score.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "support/campaigns.hpp"
#include "talus/fit/campaign/deposits.hpp"

namespace talus::test {
namespace {

using Places = std::vector<Eigen::Vector2d>;

ObserveOptions trials(std::uint32_t count, std::uint64_t seed = 1) {
  ObserveOptions how;
  how.trials = count;
  how.seed = seed;
  return how;
}

Eigen::Vector2d normal_place(Numbers& numbers, const Eigen::Vector2d& mean) {
  const double x = numbers.normal(), y = numbers.normal();
  return mean + Eigen::Vector2d(x, y);
}

/// Mean length of a normal vector in the plane with variance s^2 in each direction and mean length nu: Rice's
/// distribution, s sqrt(pi / 2) L(-nu^2 / (2 s^2)) with L(-x) = exp(-x / 2) ((1 + x) I_0(x / 2) + x I_1(x / 2)).
double mean_length(double nu, double s) {
  const double x = nu * nu / (2.0 * s * s), half = 0.5 * x;
  return s * std::sqrt(0.5 * kPi) * std::exp(-half) *
         ((1.0 + x) * std::cyl_bessel_i(0.0, half) + x * std::cyl_bessel_i(1.0, half));
}

/// Two normal patterns a distance d apart: 2 E|X - Y| - E|X - X'| - E|Y - Y'| = 2 (m(d) - m(0)), m the mean length of
/// a normal vector of twice the variance. Also with few blocks and trials: the estimate is unbiased.
TEST(PatternDistance, OfTwoNormalPatternsHasItsClosedForm) {
  Numbers numbers(21);
  for (const double apart : {0.0, 0.5, 2.0}) {
    const double expected = 2.0 * (mean_length(apart, std::sqrt(2.0)) - mean_length(0.0, std::sqrt(2.0)));
    constexpr int kSets = 4000;
    double sum = 0.0, squares = 0.0;
    for (int set = 0; set < kSets; ++set) {
      Places mapped;
      std::vector<Places> simulated(5);
      for (Places& stops : simulated) {
        mapped.push_back(normal_place(numbers, {0.0, 0.0}));
        const std::size_t count = set % 2 == 0 ? 2 : 2 + stops.size() + mapped.size();  // also of unequal number
        for (std::size_t t = 0; t < count; ++t) stops.push_back(normal_place(numbers, {apart, 0.0}));
      }
      const double d = pattern_distance(mapped, simulated).distance;
      sum += d / kSets;
      squares += d * d / kSets;
    }
    EXPECT_NEAR(sum, expected, 4.0 * std::sqrt((squares - sum * sum) / kSets)) << apart;
  }
}

/// Blocks that differ in where they go: the distance from the right model stays 0 on average.
TEST(PatternDistance, IsZeroOnAverageForBlocksThatDiffer) {
  Numbers numbers(22);
  constexpr int kSets = 4000;
  double sum = 0.0, squares = 0.0;
  for (int set = 0; set < kSets; ++set) {
    Places mapped;
    std::vector<Places> simulated(4);
    for (std::size_t b = 0; b < 4; ++b) {
      const Eigen::Vector2d own(5.0 * static_cast<double>(b), 0.0);
      mapped.push_back(normal_place(numbers, own));
      for (int t = 0; t < 3; ++t) simulated[b].push_back(normal_place(numbers, own));
    }
    const double d = pattern_distance(mapped, simulated).distance;
    sum += d / kSets;
    squares += d * d / kSets;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 * std::sqrt((squares - sum * sum) / kSets));
}

/// All blocks at one place, all stops at another: the distance is twice the way between them, all of what it can be.
TEST(PatternDistance, OfTwoHeaps) {
  const Places mapped(6, {1.0, 2.0});
  const std::vector<Places> simulated(6, Places(4, {4.0, 6.0}));
  const PatternDistance d = pattern_distance(mapped, simulated);
  EXPECT_NEAR(d.distance, 2.0 * 5.0, 1e-12);
  EXPECT_NEAR(d.share, 1.0, 1e-12);
}

/// The slope of the campaigns with a row of sources at its top, blocks of two sizes, a region that is all of it, and
/// the stops of one trial as mapped blocks.
Campaign mapped_on_slope(std::size_t blocks, const Model& truth, std::uint64_t seed, double from_x = 0.0) {
  Campaign c = campaign_on_slope(blocks);
  c.screens.clear();
  c.error = {};
  const Grid grid = c.surface.grid();
  Raster<std::uint8_t> region(grid, std::uint8_t{1});
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (grid.centre_x(column) < from_x) region.at(column, row) = 0;
  std::vector<DepositSource> sources;
  for (int i = 0; i < 20; ++i) {
    const double y = 41.0 + 2.0 * i;
    sources.push_back({{9.0, y, *c.surface.height(9.0, y)}, 4.0});
  }
  MappedDeposits deposits = mapped_deposits(sources, region);
  std::size_t number = 0;
  for (MeasuredBlock& b : c.blocks) {
    b.passages.clear();
    b.holdout = false;
    b.mass = number++ % 2 == 0 ? 300.0 : 2000.0;
    b.axes.setConstant(equivalent_diameter(b.mass, b.density));
    b.stop = Eigen::Vector2d(grid.width() - 1.0, 70.0);  // in the region, until it is known
  }
  deposits.limits = {0.5 * (equivalent_diameter(300.0, 2700.0) + equivalent_diameter(2000.0, 2700.0))};
  c.deposits = std::make_shared<const MappedDeposits>(std::move(deposits));
  const auto runs = observe(c, truth, trials(40, seed));
  for (std::size_t b = 0; b < c.blocks.size(); ++b)
    for (std::size_t t = 0; t < 40; ++t)
      if (!std::isnan(runs[b].x[t])) {
        c.blocks[b].stop = Eigen::Vector2d(runs[b].x[t], runs[b].y[t]);
        break;
      }
  return c;
}

/// Rows are fair energy scores over the spread of the class, written out anew here.
TEST(DepositScore, ByItsDefinition) {
  const Campaign c = mapped_on_slope(24, model_of_slope(), 5);
  const std::vector<bool> all(24, true);
  const auto runs = observe(c, model_of_slope(), trials(30));
  const Score s = score(c, runs, all);
  ASSERT_GE(s.groups.size(), 2U);
  EXPECT_EQ(s.groups[0].name, "deposits below 0.86 m");  // between (6 m / (pi rho))^(1/3) = 0.5965 and 1.1226 m
  EXPECT_EQ(s.groups[1].name, "deposits from 0.86 m");
  for (const RowScore& row : s.rows) {
    if (row.group > 1) continue;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    double squares = 0.0, n = 0.0, way = 0.0, pairs = 0.0, stops = 0.0;
    for (const MeasuredBlock& b : c.blocks)
      if (b.mass == c.blocks[row.block].mass) mean += *b.stop, squares += b.stop->squaredNorm(), n += 1.0;
    const BlockRuns& r = runs[row.block];
    for (std::size_t i = 0; i < 30; ++i) {
      if (std::isnan(r.x[i])) continue;
      stops += 1.0;
      way += std::hypot(r.x[i] - c.blocks[row.block].stop->x(), r.y[i] - c.blocks[row.block].stop->y());
      for (std::size_t j = 0; j < 30; ++j)
        if (!std::isnan(r.x[j])) pairs += std::hypot(r.x[i] - r.x[j], r.y[i] - r.y[j]);
    }
    const double spread = std::sqrt(squares / n - (mean / n).squaredNorm());
    EXPECT_NEAR(row.score, (way / stops - 0.5 * pairs / (stops * (stops - 1.0))) / spread, 1e-9);
  }
}

/// A search pays for trials that it cut short, as with known releases.
TEST(DepositScore, TrialsThatWereCutShortCost) {
  const Campaign c = mapped_on_slope(24, model_of_slope(), 5);
  const std::vector<bool> all(24, true);
  auto runs = observe(c, model_of_slope(), trials(30));
  const Score before = score(c, runs, all);
  EXPECT_EQ(before.cut_short, 0.0);
  for (BlockRuns& block : runs) block.cut_short = 3;  // of 30
  const Score after = score(c, runs, all);
  EXPECT_NEAR(after.cut_short, 0.1, 1e-12);
  EXPECT_NEAR(after.total, before.total + 4.0 * 0.1, 1e-12);  // docs/diagnosis-time.md, "Penalty"
}

/// The sum of rows is half the energy distance and a constant of the map: for blocks of one size the difference of two
/// models' scores is half that of their distances, within the noise of the trials.
TEST(DepositScore, DiffersFromModelToModelAsTheEnergyDistance) {
  Model hard = model_of_slope();  // blocks bounce on over the floor
  hard.grounds[0].En50 = 60.0;
  hard.grounds[0].Et50 = 1000.0;
  Campaign c = mapped_on_slope(40, model_of_slope(), 6);
  for (MeasuredBlock& b : c.blocks) b.mass = 300.0, b.axes.setConstant(equivalent_diameter(300.0, 2700.0));
  const std::vector<bool> all(40, true);
  std::array<double, 2> score_of{}, distance{};
  double spread = 0.0, error = 0.0;  // error: of the mean distances, from the trials
  {
    Places places;
    for (const MeasuredBlock& b : c.blocks) places.push_back(*b.stop);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : places) mean += p / 40.0;
    for (const Eigen::Vector2d& p : places) spread += (p - mean).squaredNorm() / 40.0;
    spread = std::sqrt(spread);
  }
  for (std::size_t m = 0; m < 2; ++m) {
    const auto runs = observe(c, m == 0 ? model_of_slope() : hard, trials(100));
    score_of[m] = score(c, runs, all).groups[0].score * spread;
    const auto patterns = check_deposits(c, runs, all).patterns;
    ASSERT_EQ(patterns.size(), 1U);
    distance[m] = patterns[0].distance;
    double n = 0.0, sum = 0.0, squares = 0.0;
    for (std::size_t b = 0; b < 40; ++b)
      for (std::size_t t = 0; t < 100; ++t)
        if (!std::isnan(runs[b].x[t])) {
          const double way = std::hypot(runs[b].x[t] - c.blocks[b].stop->x(), runs[b].y[t] - c.blocks[b].stop->y());
          n += 1.0, sum += way, squares += way * way;
        }
    error += std::sqrt((squares / n - sum / n * sum / n) / n);
  }
  EXPECT_GT(distance[1] - distance[0], 3.0);
  EXPECT_NEAR(score_of[1] - score_of[0], 0.5 * (distance[1] - distance[0]), 3.0 * error);
}

/// A model that throws its blocks out of the mapped ground scores as one that knows nothing, not better than the truth.
TEST(DepositScore, NoModelGainsByLeavingTheMap) {
  const Campaign c = mapped_on_slope(30, model_of_slope(), 7, 100.0);
  const std::vector<bool> all(30, true);
  Model stuck = model_of_slope();
  stuck.grounds[0].En50 = 0.01;
  stuck.grounds[0].Et50 = 0.01;
  stuck.grounds[0].tan_phi = 2.0;
  const auto lost = observe(c, stuck, trials(60)), right = observe(c, model_of_slope(), trials(60));
  const Score nothing = score_of_climatology(c, all);
  EXPECT_LT(check_deposits(c, lost, all).inside, 0.1);
  EXPECT_NEAR(score(c, lost, all).total, nothing.total, 1e-12);
  EXPECT_LT(score(c, right, all).total, 0.9 * nothing.total);
}

/// In what a fit minimises, blocks that most trials send off the map cost as those of known release do (`Scores`): a
/// share above a half, times four, in the rows of their places. Reported scores do not change.
TEST(DepositScore, AFitGainsNothingBySendingMostBlocksOffTheMap) {
  const Campaign c = mapped_on_slope(30, model_of_slope(), 7, 100.0);
  const std::vector<bool> all(30, true);
  const auto stay = observe(c, model_of_slope(), trials(60));
  const Score before = score(c, stay, all, fit_scoring());
  for (const auto& [left, rise] : {std::pair{30U, 0.0}, {45U, 2.0}, {60U, 4.0}}) {
    auto runs = stay;
    runs[6].ends[static_cast<std::size_t>(End::Left)] = left;
    const Score after = score(c, runs, all, fit_scoring());
    ASSERT_EQ(after.rows.size(), before.rows.size());
    for (std::size_t r = 0; r < after.rows.size(); ++r) {
      const bool place = after.groups[after.rows[r].group].name != "run-out angle" && after.rows[r].block == 6;
      EXPECT_NEAR(after.rows[r].score - before.rows[r].score, place ? rise : 0.0, 1e-12);
    }
    EXPECT_DOUBLE_EQ(score(c, runs, all).total, score(c, stay, all).total);
  }
}

/// If the map is a draw of the model the p-value is uniform: its share below 0.2 is 0.2.
TEST(DepositCheck, PValuesOfTheRightModelAreUniform) {
  int low = 0;
  constexpr int kSets = 150;
  for (std::uint64_t set = 0; set < kSets; ++set) {
    Campaign c = mapped_on_slope(8, model_of_slope(), 1000 + set);
    auto deposits = std::make_shared<MappedDeposits>(*c.deposits);
    deposits->limits.clear();
    c.deposits = deposits;
    const auto runs = observe(c, model_of_slope(), trials(40, 2000 + set));
    const auto patterns = check_deposits(c, runs, std::vector<bool>(8, true)).patterns;
    ASSERT_EQ(patterns.size(), 1U);
    if (patterns[0].p_value <= 0.2) ++low;
  }
  EXPECT_NEAR(low, 0.2 * kSets, 3.5 * std::sqrt(0.2 * 0.8 * kSets));
}

/// A campaign in name only: blocks of two sizes that go to places of their own, normal around them, some with few
/// stops.
///
/// @param shift  of the places on the map, where the model is wrong
struct NormalPlaces {
  static constexpr std::size_t kBlocks = 12;
  Campaign campaign = mapped_on_slope(kBlocks, model_of_slope(), 5);
  std::vector<BlockRuns> runs{kBlocks};

  /// @param stops  of block b: stops + b modulo `kinds`
  /// @param shift  of the places on the map, where the model is wrong
  void draw(Numbers& numbers, std::size_t stops, std::size_t kinds, double shift = 0.0) {
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const Eigen::Vector2d own(0.3 * static_cast<double>(b), 0.0);
      campaign.blocks[b].stream = static_cast<std::uint32_t>(numbers.bits());
      campaign.blocks[b].stop = normal_place(numbers, own + Eigen::Vector2d(shift, 0.0));
      runs[b].trials = static_cast<std::uint32_t>(stops + b % kinds);
      runs[b].x.clear();
      runs[b].y.clear();
      for (std::uint32_t t = 0; t < runs[b].trials; ++t) {
        const Eigen::Vector2d place = normal_place(numbers, own);
        runs[b].x.push_back(place.x());
        runs[b].y.push_back(place.y());
      }
    }
  }
  DepositCheck check() const { return check_deposits(campaign, runs, std::vector<bool>(kBlocks, true)); }
};

/// If the model is right, the mapped pattern is the farthest of 100 (99 random ones and itself) with probability 1/100,
/// however few stops a block has. So p <= a holds for a share of a of the maps, within 3.5 standard errors of a
/// binomial number. Patterns that repeat after 10 stops gave p <= 0.01 for one map in eleven. With two classes a false
/// alarm comes once in twenty maps at most.
TEST(DepositCheck, PValuesAreExactForAnyNumberOfStops) {
  constexpr int kSets = 1000;
  const auto error = [](double share) { return 3.5 * std::sqrt(share * (1.0 - share) * kSets); };
  NormalPlaces places;
  Numbers numbers(23);
  for (const auto& [stops, kinds] : {std::pair{10U, 1U}, std::pair{20U, 1U}, std::pair{10U, 3U}}) {
    std::array<int, 3> low{};
    int alarms = 0;
    for (int set = 0; set < kSets; ++set) {
      places.draw(numbers, stops, kinds);
      const auto patterns = places.check().patterns;
      ASSERT_EQ(patterns.size(), 2U);
      const double p = patterns[0].p_value;
      low[0] += p <= 0.011 ? 1 : 0, low[1] += p <= 0.051 ? 1 : 0, low[2] += p <= 0.201 ? 1 : 0;
      alarms += std::min(patterns[0].corrected, patterns[1].corrected) < 0.05 ? 1 : 0;
      EXPECT_NEAR(std::min(patterns[0].corrected, patterns[1].corrected), 2.0 * std::min({p, patterns[1].p_value, 0.5}),
                  1e-12);  // Holm's of two
    }
    std::printf(
        "%u to %u stops of a block: p <= 0.01, 0.05, 0.2 for %.1f, %.1f, %.1f %% of the maps, an alarm for %.1f %%\n",
        stops, stops + kinds - 1, 100.0 * low[0] / kSets, 100.0 * low[1] / kSets, 100.0 * low[2] / kSets,
        100.0 * alarms / kSets);
    EXPECT_NEAR(low[0], 0.01 * kSets, error(0.01));
    EXPECT_NEAR(low[1], 0.05 * kSets, error(0.05));
    EXPECT_NEAR(low[2], 0.20 * kSets, error(0.20));
    EXPECT_LE(alarms, 0.05 * kSets + error(0.05));
  }
}

/// A map far beside the stops is none of the model, into how many classes it may be cut: the docs call it "not the
/// simulated pattern" where p corrected for the classes is below 0.05. With 99 patterns five times 0.01 was not.
TEST(DepositCheck, AnotherPatternIsSeenInAnyNumberOfClasses) {
  constexpr std::size_t kBlocks = 60;
  Campaign campaign = mapped_on_slope(kBlocks, model_of_slope(), 5);
  std::vector<BlockRuns> runs(kBlocks);
  Numbers numbers(25);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    campaign.blocks[b].stop = normal_place(numbers, {5.0, 0.0});
    runs[b].trials = 20;
    for (std::uint32_t t = 0; t < runs[b].trials; ++t) {
      const Eigen::Vector2d place = normal_place(numbers, {0.0, 0.0});
      runs[b].x.push_back(place.x());
      runs[b].y.push_back(place.y());
    }
  }
  for (std::size_t classes = 1; classes <= 10; ++classes) {
    auto deposits = std::make_shared<MappedDeposits>(*campaign.deposits);
    deposits->limits.clear();
    for (std::size_t c = 0; c < classes; ++c) {
      const double diameter = 0.5 + 0.1 * static_cast<double>(c);
      if (c > 0) deposits->limits.push_back(diameter - 0.05);
      for (std::size_t b = c; b < kBlocks; b += classes)
        campaign.blocks[b].mass = campaign.blocks[b].density * kPi / 6.0 * diameter * diameter * diameter;
    }
    campaign.deposits = deposits;
    const auto patterns = check_deposits(campaign, runs, std::vector<bool>(kBlocks, true)).patterns;
    ASSERT_EQ(patterns.size(), classes);
    for (const PatternDistance& pattern : patterns) EXPECT_LT(pattern.corrected, 0.05) << pattern.group;
    if (classes <= 4) EXPECT_NEAR(patterns[0].p_value, 0.01, 1e-12);  // of 99 other patterns, as documented
  }
}

/// A map three standard deviations beside the stops is none of the model, also with ten stops.
TEST(DepositCheck, AnotherPatternIsSeenWithFewStops) {
  NormalPlaces places;
  Numbers numbers(24);
  for (int set = 0; set < 20; ++set) {
    places.draw(numbers, 10, 1, 3.0);
    for (const PatternDistance& pattern : places.check().patterns) {
      EXPECT_NEAR(pattern.p_value, 0.01, 1e-12);
      EXPECT_NEAR(pattern.corrected, 0.02, 1e-12);
    }
  }
}

}  // namespace
}  // namespace talus::test
