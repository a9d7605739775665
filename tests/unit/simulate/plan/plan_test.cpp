#include "talus/simulate/plan/plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "support/scenarios.hpp"

namespace talus {
namespace {

using test::Moments;

constexpr std::uint32_t kDraws = 64'000;

/// Cells of 2 m x 4 m on a plane; the source cell is that of (21, 42).
Scenario plain() {
  Scenario s = test::scenario_on(
      test::terrain(test::grid_of(30, 30, 2.0, 4.0), [](double x, double y) { return 100.0 - 0.5 * x + 0.25 * y; }));
  s.sources = {{0, 21.0, 42.0, false}};
  s.trajectories = kDraws;
  return s;
}

double plane_at(const Release& r) {
  return 100.0 - 0.5 * r.motion.position.x() + 0.25 * r.motion.position.y();
}

/// Pearson's statistic of counts that are expected to be equal, in standard deviations from its mean.
double chi_square_deviations(const std::vector<double>& counts) {
  double total = 0.0, statistic = 0.0;
  for (const double count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  for (const double count : counts) statistic += (count - expected) * (count - expected) / expected;
  const double freedom = static_cast<double>(counts.size()) - 1.0;
  return (statistic - freedom) / std::sqrt(2.0 * freedom);
}

TEST(MakeRelease, UniformInTheCell) {
  const Scenario s = plain();
  std::vector<double> counts(8 * 8, 0.0);
  for (std::uint32_t block = 0; block < kDraws; ++block) {
    const Vec3 p = make_release(s, 0, block).motion.position;
    const double u = (p.x() - 20.0) / 2.0, v = (p.y() - 40.0) / 4.0;
    ASSERT_TRUE(u > 0.0 && u < 1.0 && v > 0.0 && v < 1.0) << block;
    counts[static_cast<std::size_t>(u * 8.0) * 8 + static_cast<std::size_t>(v * 8.0)] += 1.0;
  }
  EXPECT_LT(std::abs(chi_square_deviations(counts)), 5.0);  // an eighth with 4 % too many fails
}

TEST(MakeRelease, HeightUniformAboveTheTerrainUnderIt) {
  Scenario s = plain();
  s.features[0].release_height = {0.5, 2.5};
  std::vector<double> counts(20, 0.0);
  for (std::uint32_t block = 0; block < kDraws; ++block) {
    const Release r = make_release(s, 0, block);
    const double share = (r.motion.position.z() - plane_at(r) - 0.5) / 2.0;
    ASSERT_TRUE(share > -1e-12 && share < 1.0 + 1e-12) << block;
    counts[std::min<std::size_t>(19, static_cast<std::size_t>(std::max(0.0, share) * 20.0))] += 1.0;
  }
  EXPECT_LT(std::abs(chi_square_deviations(counts)), 5.0);
}

TEST(MakeRelease, APointIsReleasedExactlyThere) {
  Scenario s = plain();
  s.sources = {{0, 20.3, 41.7, true}};
  s.features[0].release_height = {2.0, 2.0};
  s.features[0].velocity = {3.0, -4.0, 5.0};
  for (std::uint32_t block = 0; block < 100; ++block) {
    const Release r = make_release(s, 0, block);
    EXPECT_EQ(r.motion.position.x(), 20.3);
    EXPECT_EQ(r.motion.position.y(), 41.7);
    EXPECT_NEAR(r.motion.position.z() - plane_at(r), 2.0, 1e-10);
    EXPECT_EQ(r.motion.velocity, Vec3(3.0, -4.0, 5.0));
    EXPECT_EQ(r.motion.time, 0.0);
    EXPECT_EQ(r.motion.spin, Vec3::Zero().eval());
  }
}

TEST(MakeRelease, ClassesByWeightAndUniformWithin) {
  Scenario s = plain();
  s.blocks.classes = {{{0.2, 0.4}, 1.0, kNotGiven}, {{0.5, 0.5}, 2.0, kNotGiven}, {{1.0, 2.0}, 5.0, kNotGiven}};
  double small = 0.0, middle = 0.0;
  std::vector<double> large(10, 0.0);
  for (std::uint32_t block = 0; block < kDraws; ++block) {
    const Release r = make_release(s, 0, block);
    const double d = r.body.diameter;
    if (d < 0.4)
      small += 1.0;
    else if (d == 0.5)
      middle += 1.0;
    else
      large[static_cast<std::size_t>(std::min(9.0, (d - 1.0) * 10.0))] += 1.0;
    ASSERT_TRUE((d >= 0.2 && d <= 0.4) || d == 0.5 || (d >= 1.0 && d <= 2.0)) << d;
  }
  EXPECT_NEAR(small / kDraws, 1.0 / 8.0, 5.0 * std::sqrt(1.0 / 8.0 * 7.0 / 8.0 / kDraws));
  EXPECT_NEAR(middle / kDraws, 2.0 / 8.0, 5.0 * std::sqrt(2.0 / 8.0 * 6.0 / 8.0 / kDraws));
  EXPECT_LT(std::abs(chi_square_deviations(large)), 5.0);
}

TEST(MakeRelease, PlaceHeightAndSizeAreIndependent) {
  Scenario s = plain();
  s.features[0].release_height = {0.0, 1.0};
  s.blocks.classes = {{{0.0, 1.0}, 1.0, kNotGiven}};
  Moments products[6];
  for (std::uint32_t block = 0; block < kDraws; ++block) {
    const Release r = make_release(s, 0, block);
    const double v[4] = {(r.motion.position.x() - 21.0) / 2.0, (r.motion.position.y() - 42.0) / 4.0,
                         r.motion.position.z() - plane_at(r) - 0.5, r.body.diameter - 0.5};
    for (int i = 0, k = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) products[k++].add(v[i] * v[j]);
  }
  for (const Moments& m : products) EXPECT_NEAR(m.mean(), 0.0, 5.0 * m.error());  // a correlation of 2 % fails
}

TEST(MakeRelease, PowerLawOfVolume) {  // P(V <= v) = (a^-b - v^-b) / (a^-b - c^-b) between a and c
  for (const double b : {0.4, 1.0, 1.7}) {
    Scenario s = plain();
    s.blocks.classes.clear();
    s.blocks.power_law = {{0.05, 20.0}, b};
    const double limits[] = {0.06, 0.1, 0.3, 1.0, 5.0, 15.0};
    double below[6] = {};
    for (std::uint32_t block = 0; block < kDraws; ++block) {
      const double d = make_release(s, 0, block).body.diameter, volume = kPi / 6.0 * d * d * d;
      ASSERT_TRUE(volume > 0.05 * (1.0 - 1e-9) && volume < 20.0 * (1.0 + 1e-9)) << volume;
      for (int i = 0; i < 6; ++i) below[i] += volume <= limits[i] ? 1.0 : 0.0;
    }
    for (int i = 0; i < 6; ++i) {
      const double p = (std::pow(0.05, -b) - std::pow(limits[i], -b)) / (std::pow(0.05, -b) - std::pow(20.0, -b));
      EXPECT_NEAR(below[i] / kDraws, p, 5.0 * std::sqrt(p * (1.0 - p) / kDraws)) << b << ' ' << limits[i];
    }
  }
}

/// For b towards 0 the logarithm of the volume is uniform.
TEST(MakeRelease, TheSmallestExponentHasAsManyBlocksInEachOctave) {
  Scenario s = plain();
  s.blocks.classes.clear();
  s.blocks.power_law = {{1e-6, 65000.0}, 1e-6};
  double below[8] = {};
  for (std::uint32_t block = 0; block < kDraws; ++block) {
    const double d = make_release(s, 0, block).body.diameter, volume = kPi / 6.0 * d * d * d;
    ASSERT_TRUE(volume > 1e-6 * (1.0 - 2e-15) && volume < 65000.0 * (1.0 + 2e-15)) << volume;
    for (int i = 0; i < 8; ++i) below[i] += std::log(volume / 1e-6) <= i / 8.0 * std::log(65000.0 / 1e-6) ? 1.0 : 0.0;
  }
  for (int i = 0; i < 8; ++i) {
    const double p = i / 8.0;
    EXPECT_NEAR(below[i] / kDraws, p, 5.0 * std::sqrt(p * (1.0 - p) / kDraws)) << i;
  }
}

TEST(MakeRelease, PowerLawOfOneVolume) {
  Scenario s = plain();
  s.blocks.classes.clear();
  s.blocks.power_law = {{2.0, 2.0}, 1.2};
  for (std::uint32_t block = 0; block < 100; ++block)
    EXPECT_NEAR(make_release(s, 0, block).body.diameter, std::cbrt(12.0 / kPi), 1e-12);
}

TEST(MakeRelease, ADiameterOfTheFeatureGoesFirst) {
  Scenario s = plain();
  s.features.push_back(s.features[0]);
  s.features[1].diameter = {3.0, 4.0};
  s.sources.push_back({1, 25.0, 42.0, false});
  Moments diameter;
  for (std::uint32_t block = 0; block < 10'000; ++block) {
    EXPECT_EQ(make_release(s, 0, block).body.diameter, 1.0);
    const double d = make_release(s, 1, block).body.diameter;
    EXPECT_TRUE(d > 3.0 && d < 4.0);
    diameter.add(d);
  }
  EXPECT_NEAR(diameter.mean(), 3.5, 5.0 * diameter.error());
  EXPECT_NEAR(diameter.error() * 100.0, std::sqrt(1.0 / 12.0), 0.01);
}

TEST(MakeRelease, MassOfASphere) {
  Scenario s = plain();
  s.blocks.density = 2500.0;
  s.blocks.classes = {{{2.0, 2.0}, 1.0, kNotGiven}};
  EXPECT_NEAR(make_release(s, 0, 0).body.mass, 2500.0 * 4.0 / 3.0 * kPi, 1e-9);  // of radius 1
}

TEST(MakeRelease, OneReleaseDoesNotDependOnTheOthers) {
  Scenario few = plain();
  few.trajectories = 5;
  Scenario many = few;
  many.trajectories = 100'000;
  many.sources.push_back({0, 31.0, 42.0, false});
  many.output.paths = 1;
  for (std::uint32_t block = 0; block < 5; ++block) {
    const Release a = make_release(few, 0, block), b = make_release(many, 0, block);
    EXPECT_EQ(a.motion.position, b.motion.position);
    EXPECT_EQ(a.body.diameter, b.body.diameter);
    EXPECT_EQ(a.seed, b.seed);
    EXPECT_EQ(b.source, 0U);
    EXPECT_EQ(b.block, block);
  }
}

TEST(MakeRelease, SeedSourceAndBlockAllMatter) {
  Scenario s = plain();
  s.sources.push_back(s.sources[0]);
  const double x = make_release(s, 0, 0).motion.position.x();
  EXPECT_NE(make_release(s, 1, 0).motion.position.x(), x);
  EXPECT_NE(make_release(s, 0, 1).motion.position.x(), x);
  s.seed = 2;
  EXPECT_NE(make_release(s, 0, 0).motion.position.x(), x);
}

TEST(MakeRelease, OffTheTerrainTheHeightIsNaNAndThePathLeavesAtOnce) {
  Scenario s = plain();
  s.sources = {{0, 0.5, 42.0, true}};  // west of the first centres
  const Release r = make_release(s, 0, 0);
  EXPECT_TRUE(std::isnan(r.motion.position.z()));
  Path path;
  trace(s.world(), r, path);
  EXPECT_EQ(path.end, End::Left);
  EXPECT_EQ(path.length, 0.0);
  EXPECT_TRUE(path.spans.empty());
}

TEST(IsRecorded, ExactlyAsManyAsWantedAndEvenlySpread) {
  for (const std::uint32_t trajectories : {1U, 3U, 100U, 257U})
    for (const std::uint32_t sources : {1U, 2U, 13U})
      for (const std::uint32_t wanted : {0U, 1U, 2U, 7U, 100U, 500U, 1'000'000U, 4'000'000'000U}) {
        Scenario s = plain();
        s.sources.assign(sources, s.sources[0]);
        s.trajectories = trajectories;
        s.output.paths = wanted;
        const std::uint64_t all = std::uint64_t{sources} * trajectories,
                            expected = std::min<std::uint64_t>(wanted, all);
        std::uint64_t recorded = 0, g = 0;
        for (std::uint32_t source = 0; source < sources; ++source)
          for (std::uint32_t block = 0; block < trajectories; ++block) {
            recorded += is_recorded(s, source, block) ? 1U : 0U;
            const double even = static_cast<double>(++g) * static_cast<double>(expected) / static_cast<double>(all);
            ASSERT_LE(std::abs(static_cast<double>(recorded) - even), 1.0)
                << trajectories << ' ' << sources << ' ' << wanted;
          }
        ASSERT_EQ(recorded, expected) << trajectories << ' ' << sources << ' ' << wanted;
      }
}

/// A plan of 4e12 releases that records 1e7 of their paths: every 400 000th. The product of the two numbers does not
/// fit 64 bits.
TEST(IsRecorded, LargestPlans) {
  Scenario s = plain();
  s.sources.assign(4000, s.sources.front());
  s.trajectories = 1'000'000'000;
  s.output.paths = 10'000'000;
  const auto last = static_cast<std::uint32_t>(s.sources.size() - 1);
  EXPECT_TRUE(is_recorded(s, last, s.trajectories - 1));
  EXPECT_TRUE(is_recorded(s, last, s.trajectories - 400'001));
  for (std::uint32_t before = 2; before < 1000; ++before) EXPECT_FALSE(is_recorded(s, last, s.trajectories - before));
}

}  // namespace
}  // namespace talus
