#include "talus/products/barrier_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "talus/base/random.hpp"
#include "talus/base/sample.hpp"
#include "talus/products/weibull.hpp"

namespace talus {
namespace {

/// 0, 1, ... 100 times a unit: the percentiles are the numbers. All of 1 kg, at the start of the line.
std::vector<LineCrossing> hundred(double speed_unit, double height_unit) {
  std::vector<LineCrossing> crossings;
  for (int i = 100; i >= 0; --i) crossings.push_back({speed_unit * i, height_unit * i, 1.0, 0.0, 1.0});
  return crossings;
}

/// Each a block of its own.
std::vector<LineCrossing> at_places(const std::vector<double>& places) {
  std::vector<LineCrossing> crossings;
  for (const double place : places) crossings.push_back({1.0, 1.0, 1.0, place, 1.0, crossings.size()});
  return crossings;
}

/// By hand: v95 = 0.2 * 95 = 19, v_d = 19 * 1.02 * 1.10 = 21.318 m/s; m_d = 2 * 2500 * 1.02 = 5100 kg;
/// E_d = 1/2 * 5100 * 21.318^2 = 1 158 866 J; h95 = 0.04 * 95 = 3.8 m, f_min = half of the sphere of 2 m3,
/// (6 * 2 / pi)^(1/3) / 2 = 0.781593 m, h_i = 3.8 * 1.122 + 0.781593 = 5.045193 m, h_top = h_i + 0.781593 m. The block
/// at 19 m/s has the 95th percentile of the energies: 1/2 * 1 kg * 19^2 = 180.5 J.
TEST(DesignBarrier, ByHand) {
  DesignFactors factors;
  factors.trajectory = 1.02;
  factors.topography = 1.10;
  factors.volume = 1.02;
  const BarrierDesign d = design_barrier(hundred(0.2, 0.04), {2.0, 2500.0}, factors);
  EXPECT_NEAR(d.speed_percentile, 19.0, 1e-12);
  EXPECT_NEAR(d.height_percentile, 3.8, 1e-12);
  EXPECT_NEAR(d.speed, 21.318, 1e-12);
  EXPECT_NEAR(d.mass, 5100.0, 1e-9);
  EXPECT_NEAR(d.energy, 1158865.67, 0.01);
  EXPECT_NEAR(d.sel, d.energy, 1e-6);
  EXPECT_NEAR(d.mel, 1.3 * d.energy, 1e-6);
  EXPECT_NEAR(d.freeboard, 0.781593, 1e-6);
  EXPECT_NEAR(d.height, 5.045193, 1e-6);
  EXPECT_NEAR(d.top, 5.826786, 1e-6);
  EXPECT_NEAR(d.energy_percentile, 180.5, 1e-9);
}

/// The freeboard of small blocks is half a metre: up to a diameter of 1 m, pi / 6 m3.
TEST(DesignBarrier, FreeboardIsHalfAMetreAtLeast) {
  const auto freeboard = [](double volume) {
    return design_barrier(hundred(0.2, 0.0), {volume, 2700.0}, {}).freeboard;
  };
  EXPECT_EQ(freeboard(0.1), 0.5);
  const BarrierDesign small = design_barrier(hundred(0.2, 0.0), {0.001, 2700.0}, {});
  EXPECT_NEAR(small.top, 0.124070, 1e-6);  // a sphere of one litre
  EXPECT_EQ(small.height, 0.5);
  EXPECT_NEAR(freeboard(8.0 * 3.14159265358979 / 6.0), 1.0, 1e-12);
}

/// 0, 1, ... 100 m/s and m, each 1 kg: above 70.5 m/s are 30 of 101, above 90.5 m/s 10, above 79.5 m 21.
TEST(DesignBarrier, HowOftenItIsExceeded) {
  BarrierDesign design{};
  design.sel = 0.5 * 70.5 * 70.5;
  design.mel = 0.5 * 90.5 * 90.5;
  design.height = 79.5;
  const DesignExceeded exceeded = exceeded_by(hundred(1.0, 1.0), design);
  EXPECT_NEAR(exceeded.sel, 30.0 / 101.0, 1e-12);
  EXPECT_NEAR(exceeded.mel, 10.0 / 101.0, 1e-12);
  EXPECT_NEAR(exceeded.height, 21.0 / 101.0, 1e-12);
}

TEST(DesignBarrier, AnyPercentile) {
  DesignFactors factors{1.0, 1.0, 1.0, 1.0, 1.0, 1.2, 0.5, 0.975};
  const BarrierDesign d = design_barrier(hundred(0.2, 0.04), {2.0, 2500.0}, factors);
  EXPECT_NEAR(d.speed, 19.5, 1e-12);
  EXPECT_NEAR(d.mel / d.sel, 1.2, 1e-12);
  EXPECT_EQ(fewest_for_percentile(0.95), 20U);
  EXPECT_EQ(fewest_for_percentile(0.5), 2U);
  EXPECT_EQ(fewest_for_percentile(0.99), 100U);
  EXPECT_EQ(fewest_for_percentile(0.9999), 10000U);  // 1 - 0.9999 is not 1e-4 to the last bit
}

/// Energies of the paper's Table 4, given to 10 kJ: MEL / SEL is the factor of the program in three rows, within what
/// rounding allows; the fourth is not of the same factor.
TEST(Table4, RatioOfTheEnergyLevels) {
  const DesignFactors factors;
  const auto agrees = [&](double sel, double mel) {
    return (mel - 5.0) / (sel + 5.0) <= factors.mel / factors.sel &&
           factors.mel / factors.sel <= (mel + 5.0) / (sel - 5.0);
  };
  EXPECT_TRUE(agrees(1070.0, 1390.0));
  EXPECT_TRUE(agrees(1020.0, 1320.0));
  EXPECT_TRUE(agrees(1150.0, 1490.0));
  EXPECT_FALSE(agrees(1320.0, 1610.0));
}

/// Two exceedances of a height fix a Weibull law: k = ln(ln p1 / ln p2) / ln(h1 / h2). Mean and P95 of the laws of
/// Table 4 are those in docs/barrier.md, "Table 4 of the paper".
TEST(Table4, JumpHeightsRecovered) {
  struct Row {
    double h1, p1, h2, p2, shape, scale, mean, p95;
  };
  for (const Row& r :
       {Row{4.02, 0.024, 4.66, 0.011, 1.29, 1.44, 1.34, 3.39}, Row{4.16, 0.062, 4.91, 0.033, 1.23, 1.82, 1.70, 4.42}}) {
    const double shape = std::log(std::log(r.p1) / std::log(r.p2)) / std::log(r.h1 / r.h2);
    const Weibull law{shape, r.h1 / std::pow(-std::log(r.p1), 1.0 / shape)};
    EXPECT_NEAR(law.shape, r.shape, 0.005);
    EXPECT_NEAR(law.scale, r.scale, 0.005);
    EXPECT_NEAR(law.exceedance(r.h2), r.p2, 1e-12);
    EXPECT_NEAR(law.scale * std::tgamma(1.0 + 1.0 / law.shape), r.mean, 0.01);
    EXPECT_NEAR(law.exceedance(r.p95), 0.05, 0.0005);
  }
}

/// 99 of 100 blocks in 10 m, one far off.
TEST(ShortestStretch, LeavesOutTheFarOnes) {
  std::vector<double> places{500.0};
  for (int i = 0; i < 99; ++i) places.push_back(100.0 + i * 10.0 / 98.0);
  const Stretch s = shortest_stretch(at_places(places), 0.99);
  EXPECT_NEAR(s.from, 100.0, 1e-12);
  EXPECT_NEAR(s.to, 110.0, 1e-12);
  EXPECT_NEAR(s.share, 0.99, 1e-12);
  for (double& place : places) place = 600.0 - place;  // seen from the other end
  EXPECT_NEAR(shortest_stretch(at_places(places), 0.99).from, 490.0, 1e-12);
  EXPECT_NEAR(shortest_stretch(at_places(places), 1.0).width(), 400.0, 1e-12);
  EXPECT_EQ(shortest_stretch(at_places(places), 1e-9).width(), 0.0);
}

/// Bins of 5 m of 1000 released blocks: 11 in the one from 10 m, 10 in that from 20 m, 12 in that from 30 m. Above
/// 1 %: from 10 m to 35 m.
TEST(StretchAbove, ThePapersRule) {
  std::vector<double> places(11, 12.0);
  places.insert(places.end(), 10, 21.0);
  places.insert(places.end(), 12, 34.9);
  const auto s = stretch_above(at_places(places), 5.0, 1000.0, 0.01);
  ASSERT_TRUE(s.has_value());
  EXPECT_EQ(s->from, 10.0);
  EXPECT_EQ(s->to, 35.0);
  EXPECT_EQ(s->share, 1.0);
  EXPECT_EQ(stretch_above(at_places(places), 5.0, 1000.0, 0.0115)->from, 30.0);
  EXPECT_FALSE(stretch_above(at_places(places), 5.0, 1000.0, 0.012).has_value());
}

/// Eleven pieces of ten blocks in a bin, and eleven blocks in another: of 1000 released blocks only the second has more
/// than 1 %. A weight of 0 changes nothing.
TEST(StretchAbove, CountsBlocksNotPieces) {
  std::vector<LineCrossing> crossings = at_places(std::vector<double>(22, 12.0));
  for (std::size_t i = 11; i < 22; ++i) crossings[i].along = 31.0;
  for (LineCrossing& crossing : crossings) crossing.weight = crossing.along > 20.0 ? 0.0 : 1.0;
  EXPECT_EQ(stretch_above(crossings, 5.0, 1000.0, 0.01)->from, 10.0);
  crossings[10].block = 0;
  const auto s = stretch_above(crossings, 5.0, 1000.0, 0.01);
  ASSERT_TRUE(s.has_value());
  EXPECT_EQ(s->from, 30.0);
  EXPECT_EQ(s->to, 35.0);
  EXPECT_EQ(s->share, 0.0);
}

/// By hand: a block of two pieces of weight 2 and one of weight 3, both of a stratum of 4 blocks; a block of weight 5,
/// alone in its stratum. Squares 4^2 + 3^2 + 5^2; overlap ((4 + 3)^2 - 4^2 - 3^2) / 3.
TEST(CrossingSums, ByHand) {
  std::vector<LineCrossing> crossings;
  for (const auto& [weight, block, stratum, blocks] :
       {std::tuple{2.0, 0U, 0U, 4U}, {3.0, 1U, 0U, 4U}, {5.0, 2U, 1U, 1U}, {2.0, 0U, 0U, 4U}})
    crossings.push_back({1.0, 1.0, 1.0, 0.0, weight, block, stratum, blocks});
  const CrossingSums sums = sums_of(crossings);
  EXPECT_EQ(sums.sum, 12.0);
  EXPECT_EQ(sums.squares, 50.0);
  EXPECT_EQ(sums.overlap, 8.0);
  EXPECT_EQ(sums.largest, 5.0);
  EXPECT_TRUE(sums.pieces);
  crossings.pop_back();
  EXPECT_FALSE(sums_of(crossings).pieces);
}

/// 200 blocks of 1/200 event per year.
WeightScale of_200_blocks() {
  return {0x1p-40, 0x1p-60, 1.0, std::llround(0.005 * 0x1p40), 200, true};
}

/// Clopper-Pearson of 10 in 200: 0.0242 to 0.0900 (their tables).
TEST(CrossingsPerYear, OfWholeBlocksIsTheirAnnualFrequency) {
  std::vector<LineCrossing> crossings = at_places(std::vector<double>(10, 1.0));
  for (LineCrossing& crossing : crossings) crossing.weight = 0.005;
  const CrossingSums sums = sums_of(crossings);
  const Bounded often = crossings_per_year(sums, sums, of_200_blocks());
  EXPECT_NEAR(often.value, 0.05, 1e-12);
  EXPECT_NEAR(often.low, 0.0242, 5e-5);
  EXPECT_NEAR(often.high, 0.0900, 5e-5);
}

/// Numbers of pieces at random, of 100 blocks that fall once a year together: the bounds hold the true mean.
TEST(CrossingsPerYear, BoundsOfPiecesCoverAtLeast95Percent) {
  std::mt19937_64 engine(3);
  constexpr int kBlocks = 100, kTrials = 2000;
  const WeightScale scale{0x1p-40, 0x1p-60, 1.0, std::llround(0.01 * 0x1p40), kBlocks, true};
  struct Breaking {
    int pieces;  // together, or none
    int times;   // of them, each by chance
    double chance;
  };
  for (const Breaking& b : {Breaking{1, 5, 0.1}, {1, 5, 0.9}, {17, 1, 0.05}, {17, 1, 0.2}, {17, 1, 0.9}, {3, 4, 0.3}}) {
    const double truth = b.pieces * b.times * b.chance;
    int misses = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::binomial_distribution<int> draw(b.times, b.chance);
      std::vector<LineCrossing> crossings;
      for (std::size_t block = 0; block < kBlocks; ++block)
        for (int left = b.pieces * draw(engine); left > 0; --left)
          crossings.push_back({1.0, 1.0, 1.0, 0.0, 1.0 / kBlocks, block, block / 50, 50});
      const CrossingSums sums = sums_of(crossings);
      const Bounded often = crossings_per_year(sums, sums, scale);
      EXPECT_EQ(often.value, sums.sum);
      misses += often.low > truth || often.high < truth ? 1 : 0;
    }
    EXPECT_LE(misses / double{kTrials}, 0.05 + 5.0 * std::sqrt(0.05 * 0.95 / kTrials)) << b.pieces << ' ' << b.chance;
  }
}

/// 86 of 100 blocks cross in one bin of 5 m, the others one to a bin: the paper's rule finds that bin alone and says
/// that it holds 86 %. The width for 99 % is seven times as long: from the bin to the 13th of 14 scattered blocks.
TEST(StretchAbove, SaysHowLittleItHolds) {
  std::vector<double> places(86, 2.0);
  for (int i = 1; i <= 14; ++i) places.push_back(5.0 * i + 1.0);
  const auto by_map = stretch_above(at_places(places), 5.0, 1000.0, 0.01);
  ASSERT_TRUE(by_map.has_value());
  EXPECT_EQ(by_map->width(), 5.0);
  EXPECT_NEAR(by_map->share, 0.86, 1e-12);
  const Stretch shortest = shortest_stretch(at_places(places), 0.99);
  EXPECT_EQ(shortest.from, 2.0);
  EXPECT_EQ(shortest.to, 66.0);
  EXPECT_NEAR(shortest.share, 0.99, 1e-12);
}

/// Against all intervals between two crossings, places and weights at random, some at equal places.
TEST(ShortestStretch, NoIntervalIsShorter) {
  for (std::uint32_t round = 0; round < 200; ++round) {
    const Random random(7, round, 0, Purpose::Impact);
    std::vector<LineCrossing> crossings;
    double all = 0.0;
    for (std::uint32_t i = 0; i < 40; ++i) {
      const auto words = random.words(i);
      const double weight = round % 2 == 0 ? 1.0 : std::pow(uniform(words[0]), 3.0) + 1e-3;
      crossings.push_back({1.0, 1.0, 1.0, std::floor(60.0 * uniform(words[1])) / 3.0, weight});
      all += weight;
    }
    for (const double containment : {0.3, 0.8, 0.95, 0.99, 1.0}) {
      double shortest = std::numeric_limits<double>::infinity();
      for (const LineCrossing& a : crossings)
        for (const LineCrossing& b : crossings) {
          double held = 0.0;
          for (const LineCrossing& c : crossings) held += c.along >= a.along && c.along <= b.along ? c.weight : 0.0;
          if (held >= (containment - 1e-9) * all) shortest = std::min(shortest, b.along - a.along);
        }
      const Stretch found = shortest_stretch(crossings, containment);
      EXPECT_EQ(found.width(), shortest) << round << ' ' << containment;
      EXPECT_GE(found.share, containment - 1e-8) << round;
    }
  }
}

TEST(WeightedQuantile, EqualWeightsAreNone) {
  const std::vector<double> values{3.0, 1.0, 4.0, 1.5, 9.0, 2.6}, sorted{1.0, 1.5, 2.6, 3.0, 4.0, 9.0};
  for (const double weight : {1.0, 0.3, 7e-5})
    for (const double share : {0.0, 0.2, 0.5, 0.77, 0.95, 1.0})
      EXPECT_EQ(weighted_quantile(values, std::vector<double>(6, weight), share), quantile(sorted, share));
}

/// Numbers 1 ... n, each weighing itself: the share below x is (x / n)^2, so that the quantile is n sqrt(share).
TEST(WeightedQuantile, OfADensityThatRises) {
  std::vector<double> values;
  for (int i = 1; i <= 10000; ++i) values.push_back(i);
  for (const double share : {0.01, 0.25, 0.5, 0.95, 0.999})
    EXPECT_NEAR(weighted_quantile(values, values, share), 1e4 * std::sqrt(share), 1.0);
}

/// A weight of 3 is three values: between the quantiles of the written-out sample one value below and above.
TEST(WeightedQuantile, AWeightIsThatManyValues) {
  std::vector<double> values, weights, written;
  for (int i = 0; i < 200; ++i) {
    values.push_back(std::fmod(i * 77.7, 31.0));
    weights.push_back(1.0 + i % 4);
    written.insert(written.end(), static_cast<std::size_t>(1 + i % 4), values.back());
  }
  std::sort(written.begin(), written.end());
  for (const double share : {0.1, 0.5, 0.9, 0.95}) {
    const double found = weighted_quantile(values, weights, share);
    EXPECT_GE(found, quantile(written, share - 4.0 / 500.0));
    EXPECT_LE(found, quantile(written, share + 4.0 / 500.0));
  }
}

/// Kish: n equal weights are n; two weights of 1 and 3 are 16 / 10.
TEST(EffectiveNumber, ByHand) {
  std::vector<LineCrossing> crossings = at_places({1.0, 2.0});
  EXPECT_EQ(effective_number(crossings), 2.0);
  crossings[1].weight = 3.0;
  EXPECT_NEAR(effective_number(crossings), 1.6, 1e-15);
}

/// A part of 100 m in pieces of 25 m, one of 10 m whole: no piece crosses from a part to the next.
TEST(StretchEdges, EqualPiecesOfEachPart) {
  EXPECT_EQ(stretch_edges(std::vector<double>{100.0, 10.0}, 30.0),
            (std::vector<double>{0.0, 25.0, 50.0, 75.0, 100.0, 110.0}));
  EXPECT_EQ(stretch_edges(std::vector<double>{90.0}, 30.0).size(), 4U);
  EXPECT_EQ(stretch_edges(std::vector<double>{20.0}, 30.0), (std::vector<double>{0.0, 20.0}));
}

/// Two gullies: 60 slow blocks of 1000 kg, 40 fast ones of 4000 kg, and three on the way between. The design of a
/// stretch is that of a line which only its blocks cross; the design of the whole line is too low for the second gully.
TEST(DesignStretches, EachByItsOwnCrossings) {
  std::vector<LineCrossing> slow, fast, all;
  for (int i = 0; i < 60; ++i) slow.push_back({5.0 + 0.01 * i, 1.0, 1000.0, 10.0 + 0.1 * i, 1.0});
  for (int i = 0; i < 40; ++i) fast.push_back({15.0 + 0.1 * i, 2.0, 4000.0, 80.0 + 0.1 * i, 1.0});
  all = fast;
  all.insert(all.end(), slow.begin(), slow.end());
  for (const double place : {41.0, 45.0, 89.9999}) all.push_back({1.0, 0.1, 500.0, place, 1.0});
  const DesignBlockRule rule{{}, 2500.0, 2500.0};
  const auto found = design_stretches(all, stretch_edges(std::vector<double>{90.0}, 30.0), rule, {});
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].crossings, 60U);
  EXPECT_EQ(found[1].crossings, 2U);
  EXPECT_EQ(found[2].crossings, 41U);
  EXPECT_FALSE(found[1].design.has_value());
  EXPECT_EQ(found[1].largest_energy, 250.0);
  ASSERT_TRUE(found[0].design && found[2].design);
  const BarrierDesign alone = design_barrier(slow, {1000.0 / 2500.0, 2500.0}, {});
  EXPECT_EQ(found[0].design->sel, alone.sel);
  EXPECT_EQ(found[0].design->height, alone.height);
  EXPECT_EQ(found[0].stretch.share, 60.0 / 103.0);
  EXPECT_EQ(found[2].largest_energy, 0.5 * 4000.0 * 18.9 * 18.9);
  EXPECT_GT(found[2].design->sel, 4.0 * found[0].design->sel);
  double share = 0.0;
  for (const StretchDesign& s : found) share += s.stretch.share;
  EXPECT_NEAR(share, 1.0, 1e-15);
}

/// A hairpin: 40 blocks cross the first leg, then, faster, the second one; half of them roll back over the first.
TEST(DesignStretches, ABlockCountsOnEachThatItCrossesOnce) {
  std::vector<LineCrossing> crossings;
  const auto cross = [&](std::size_t block, double speed, double along) {
    crossings.push_back(
        {.speed = speed, .height = 1.0, .mass = 1000.0, .along = along, .block = block, .piece = block});
  };
  for (std::size_t i = 0; i < 40; ++i) {
    cross(i, 5.0, 10.0);
    cross(i, 15.0, 50.0);
    if (i % 2 == 0) cross(i, 30.0, 5.0);
  }
  const std::vector<double> edges{0.0, 30.0, 60.0, 90.0};
  const auto found = design_stretches(crossings, edges, {}, {});
  EXPECT_EQ(found[0].crossings, 40U);
  EXPECT_EQ(found[1].crossings, 40U);
  EXPECT_EQ(found[2].crossings, 0U);
  EXPECT_EQ(found[0].design->speed_percentile, 5.0);
  EXPECT_EQ(found[1].design->speed_percentile, 15.0);
  EXPECT_EQ(found[1].stretch.share, 0.5);
  EXPECT_EQ(found[1].sums.sum, 40.0);
}

/// Sources of small blocks that fall a hundred times as often: the weights, not the numbers, say what 95 % is.
TEST(DesignStretches, RareBlocksCountAsRare) {
  std::vector<LineCrossing> crossings;
  for (int i = 0; i < 100; ++i) crossings.push_back({5.0, 0.5, 300.0, 1.0, 1.0});
  for (int i = 0; i < 100; ++i) crossings.push_back({20.0, 3.0, 300.0, 1.0, 0.01});
  const std::vector<double> edges{0.0, 2.0};
  const auto weighted = design_stretches(crossings, edges, {}, {});
  EXPECT_EQ(weighted[0].design->speed_percentile, 5.0);
  EXPECT_NEAR(weighted[0].beyond->height, 1.0 / 101.0, 1e-12);
  for (LineCrossing& crossing : crossings) crossing.weight = 1.0;
  EXPECT_EQ(design_stretches(crossings, edges, {}, {})[0].design->speed_percentile, 20.0);
}

}  // namespace
}  // namespace talus
