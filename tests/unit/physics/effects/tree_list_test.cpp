#include "talus/physics/effects/tree_list.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/slopes.hpp"
#include "talus/physics/effects/tree_species.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;
using test::Moments;
using test::Numbers;
using test::same_bits;

std::shared_ptr<const ForestMap> map_of(const std::vector<Tree>& trees) {
  auto map = std::make_shared<ForestMap>();
  map->trees = TreeList(trees);
  return map;
}

/// Trees of the list act whatever the number of the density; it only switches the effect on.
ForestStems forest_of(const std::vector<Tree>& trees, double height = 1e9, double factor = 1e-9) {
  return {.density = 1.0, .height = height, .species_factor = factor, .where = {}, .map = map_of(trees)};
}

std::vector<Tree> random_trees(std::uint64_t seed, double side, double per_hectare, double diameter) {
  Numbers numbers(seed);
  std::vector<Tree> trees(static_cast<std::size_t>(side * side * 1e-4 * per_hectare));
  for (Tree& tree : trees) {
    const double x = numbers.uniform(0.0, side);
    tree = {{x, numbers.uniform(0.0, side)}, diameter, 1.0};
  }
  return trees;
}

std::size_t stems_on(const Path& path) {
  return static_cast<std::size_t>(std::count_if(path.vertices.begin(), path.vertices.end(),
                                                [](const Vertex& v) { return v.event == Event::Stem; }));
}

const Vertex& first_stem(const Path& path) {
  return *std::find_if(path.vertices.begin(), path.vertices.end(),
                       [](const Vertex& v) { return v.event == Event::Stem; });
}

TEST(TreeList, TheWayToADiscIsThatOfTheCircle) {
  const Eigen::Vector2d east(1.0, 0.0);
  EXPECT_NEAR(way_to_disc({10.0, 0.0}, east, 2.0), 8.0, 1e-14);
  EXPECT_NEAR(way_to_disc({10.0, 1.2}, east, 2.0), 10.0 - 1.6, 1e-14);  // 1.2, 1.6, 2
  EXPECT_EQ(way_to_disc({10.0, 2.0}, east, 2.0), INFINITY);             // touches it only
  EXPECT_EQ(way_to_disc({-10.0, 0.0}, east, 2.0), INFINITY);            // behind
  EXPECT_EQ(way_to_disc({1.0, 0.5}, east, 2.0), INFINITY);              // begins inside
  EXPECT_EQ(way_to_disc({NAN, 0.0}, east, 2.0), INFINITY);
}

/// The index against all trees one by one, in any direction, also for blocks much larger than its cells.
TEST(TreeList, TheIndexFindsTheFirstOfAllTrees) {
  const std::vector<Tree> trees = random_trees(3, 300.0, 400.0, 0.4);
  const TreeList list(trees);
  ASSERT_EQ(list.size(), trees.size());
  Numbers numbers(4);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const double turn = numbers.uniform(0.0, 2.0 * kPi), diameter = i % 20 == 0 ? 30.0 : numbers.uniform(0.1, 3.0);
    PlanWay way;
    way.from = {numbers.uniform(-50.0, 350.0), numbers.uniform(-50.0, 350.0)};
    way.heading = {std::cos(turn), std::sin(turn)};
    way.length = numbers.uniform(0.0, 150.0);
    double nearest = INFINITY;
    for (const Tree& tree : trees)
      nearest = std::min(nearest, way_to_disc(tree.place - way.from, way.heading, 0.5 * (tree.diameter + diameter)));
    const auto found = list.first_on(way, diameter, {});
    ASSERT_EQ(found.has_value(), nearest <= way.length) << i;
    if (!found) continue;
    ++met;
    EXPECT_EQ(found->way, nearest);
    const Eigen::Vector2d to = list.at(found->tree).place - (way.from + found->way * way.heading);
    const double radius = 0.5 * (0.4 + diameter);
    EXPECT_NEAR(to.norm(), radius, 1e-9);
    EXPECT_NEAR(found->eccentricity, (way.heading.x() * to.y() - way.heading.y() * to.x()) / radius, 1e-9);
  }
  EXPECT_GT(met, 800);
}

/// A block that flies into one tree: hit at (DBH + D)/2 before its axis, with the loss and the turn of the law.
TEST(TreeList, ABlockHitsTheTreeInItsWayWithItsTrueOffset) {
  Hillside hill(0.0);
  const double offset = 0.2;  // the axis is on the left
  hill.effects.forest_stems = forest_of({{{300.0, 400.0 + offset}, 0.4, 1.5}}, 1e9, 2.0);
  const Path path = hill.run(block_at({100.0, 400.0, 1400.0}, {40.0, 0.0, 0.0}));
  ASSERT_EQ(stems_on(path), 1U);
  const auto stem = &first_stem(path);
  const double radius = 0.5 * (0.4 + 1.0), e = offset / radius;
  EXPECT_NEAR(stem->motion.position.x(), 300.0 - std::sqrt(radius * radius - offset * offset), 1e-6);
  EXPECT_NEAR(stem->motion.position.y(), 400.0, 1e-9);
  const double time = (stem->motion.position.x() - 100.0) / 40.0;
  EXPECT_NEAR(stem->motion.time, time, 1e-9);
  const Vec3 before(40.0, 0.0, -kGravity * time);
  const double taken = 2.0 * 1.5 * 38.7 * std::pow(40.0, 2.31) * stem_share(e) / block_of(1.0, 2700.0).mass;
  EXPECT_NEAR(before.squaredNorm() - stem->motion.velocity.squaredNorm(), 2.0 * taken, 1e-6);
  EXPECT_LT(stem->motion.velocity.y(), 0.0);  // turned to the right
  EXPECT_NEAR((stem->motion.velocity - velocity_after_stem(before, taken, e)).norm(), 0.0, 1e-6);
}

TEST(TreeList, OneThatPassesAboveOrBesideKeepsEveryBit) {
  Hillside plain(0.3), acting(0.3);
  plain.acting = false;
  acting.effects.forest_stems = forest_of({{{300.0, 404.0}, 0.4, 1.0}, {{700.0, 100.0}, 2.0, 1.0}}, 30.0, 1.0);
  const Release beside = block_at({20.0, 395.0, 1000.0}, {15.0, 0.0, 0.0});
  plain.cover.grounds[0] = acting.cover.grounds[0] = {.theta_scale = 0.2, .psi_scale = 0.0};
  const Path a = plain.run(beside), b = acting.run(beside);
  EXPECT_GT(a.impacts, 5U);
  EXPECT_TRUE(same_bits(a, b));
  const Path above = acting.run(block_at({20.0, 404.0, 1400.0}, {60.0, 0.0, 0.0}));  // about 300 m above the tree
  EXPECT_EQ(stems_on(above), 0U);
}

/// Trees at random (Poisson): ways between hits have the mean 1/(n (d + D)), as the stems of a uniform stand.
TEST(TreeList, TheFreePathAmongRandomTreesIsThatOfTheUniformStand) {
  constexpr double kSide = 1600.0, kPerHectare = 300.0, kDbh = 0.3, kBlock = 1.2;
  const double mean = 1e4 / (kPerHectare * (kDbh + kBlock));  // closed form [m]
  Hillside listed(0.0, 8.0, 200), uniform(0.0, 8.0, 200);
  listed.effects.forest_stems = forest_of(random_trees(11, kSide, kPerHectare, kDbh));
  uniform.effects.forest_stems = {
      .density = kPerHectare, .diameter = kDbh, .height = 1e9, .species_factor = 1e-9, .where = {}};
  Numbers numbers(12);
  Moments in_list, in_stand;
  int beyond = 0;
  for (std::uint32_t block = 0; block < 6000; ++block) {
    const Vec3 from(20.0, numbers.uniform(20.0, 1580.0), 5000.0);
    const Release release = block_at(from, {80.0, 0.0, 0.0}, kBlock, block);
    for (const auto& [hill, moments] : {std::pair{&listed, &in_list}, std::pair{&uniform, &in_stand}}) {
      const double way = first_stem(hill->run(release)).motion.position.x() - from.x();
      moments->add(way);
      if (moments == &in_list && way > 2.0 * mean) ++beyond;
    }
  }
  // Neighbouring ways meet the same trees: of 1560 m of width about 1560/1.5 ways are independent.
  const double independent = 1560.0 / (kDbh + kBlock);
  EXPECT_NEAR(in_list.mean(), mean, 5.0 * mean / std::sqrt(independent));
  EXPECT_NEAR(in_stand.mean(), mean, 5.0 * mean / std::sqrt(6000.0));
  EXPECT_NEAR(in_list.mean(), in_stand.mean(), 5.0 * mean / std::sqrt(independent));
  const double p = std::exp(-2.0);
  EXPECT_NEAR(beyond / 6000.0, p, 5.0 * std::sqrt(p * (1.0 - p) / independent));
}

/// A planted strip of length L: the share of blocks that no tree meets is exp(-n (d + D) L).
TEST(TreeList, APlantedStripLetsThroughWhatTheClosedFormSays) {
  constexpr double kLength = 40.0, kPerHectare = 400.0;
  Numbers numbers(21);
  int free = 0;
  constexpr int kForests = 400, kBlocks = 4;  // far apart in each forest: independent
  for (int forest = 0; forest < kForests; ++forest) {
    std::vector<Tree> trees;
    for (int i = 0; i < static_cast<int>(kLength * 400.0 * 1e-4 * kPerHectare); ++i) {
      const double x = 100.0 + numbers.uniform(0.0, kLength);
      trees.push_back({{x, numbers.uniform(0.0, 400.0)}, 0.3, 1.0});
    }
    Hillside hill(0.0, 8.0, 50);
    hill.effects.forest_stems = forest_of(trees, 1e9, 1e6);
    for (int block = 0; block < kBlocks; ++block)
      free += stems_on(hill.run(block_at({20.0, 60.0 + 90.0 * block, 3000.0}, {60.0, 0.0, 0.0}, 0.7))) == 0 ? 1 : 0;
  }
  const double p = std::exp(-kPerHectare * 1e-4 * (0.3 + 0.7) * kLength), n = kForests * kBlocks;
  EXPECT_NEAR(free / n, p, 5.0 * std::sqrt(p * (1.0 - p) / n));  // 0.202
}

/// Rolling and sliding blocks meet trees, too: a row of thick trees across a slope that holds none.
TEST(TreeList, SlidingBlocksMeetTrees) {
  Hillside hill(0.7, 2.0, 200);
  hill.cover.grounds[0] = {.theta_scale = 0.0, .psi_scale = 0.0, .En50 = 1e-3, .Et50 = 1e6, .tan_phi = 0.3};
  std::vector<Tree> row;
  for (int i = 0; i < 100; ++i) row.push_back({{200.0, 150.0 + i}, 1.0, 1.0});
  const Release release = block_at({20.0, 200.3, 986.0}, {1.0, 0.0, -0.7});
  const double free = hill.run(release).plan_length;
  hill.effects.forest_stems = forest_of(row, 20.0, 1e6);
  const Path path = hill.run(release);
  const auto slides = [](const Path& p) {
    return std::count_if(p.vertices.begin(), p.vertices.end(), [](const Vertex& v) { return v.event == Event::Slide; });
  };
  EXPECT_GT(slides(path), 10);
  double slowest = 1e9;  // near the row
  for (const Vertex& v : path.vertices)
    if (std::abs(v.motion.position.x() - 199.5) < 2.0) slowest = std::min(slowest, v.motion.velocity.norm());
  EXPECT_LT(slowest, 1.0);
  EXPECT_GT(free, 300.0);
}

TEST(TreeList, TwoTreesAtOnePlaceAndBlocksAmongThemEnd) {
  Hillside hill(0.6);
  std::vector<Tree> trees(9, Tree{{200.0, 400.0}, 0.8, 1.0});
  for (int i = 0; i < 40; ++i) trees.push_back({{230.0 + 0.1 * i, 400.0 + 0.05 * (i % 7)}, 1.5, 1.0});
  hill.effects.forest_stems = forest_of(trees, 20.0, 0.01);
  const Path path = hill.run(block_at({150.0, 400.1, 915.0}, {12.0, 0.0, 0.0}));
  EXPECT_GT(stems_on(path), 0U);
  EXPECT_LT(path.vertices.size(), 20'000U);
  EXPECT_LT(path.vertices.back().motion.time, hill.rules.time_limit);
}

TEST(TreeSpecies, AreKnownByName) {
  EXPECT_EQ(factor_of_species("silver fir"), 1.0);
  EXPECT_EQ(factor_of_species("Abies_alba"), 1.0);
  EXPECT_EQ(factor_of_species("conifer"), 0.93);
  EXPECT_EQ(factor_of_species("broadleaf"), 1.59);
  EXPECT_TRUE(factor_of_species("Broadleaf").has_value());
  EXPECT_FALSE(factor_of_species("palm").has_value());
}

}  // namespace
}  // namespace talus
