#include "talus/physics/effects/fragmentation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <set>

#include "support/slopes.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;
using test::same_bits;

TEST(Fragmentation, MassesAddUp) {
  for (const double largest : {0.5, 0.7, 0.9})
    for (const double mass : {3.0, 17.0, 2500.0, 1e6})
      for (const std::uint32_t most : {0U, 1U, 3U, 16U}) {
        const std::vector<double> masses =
            piece_masses({.threshold = 1.0, .largest = largest, .where = {}}, mass, most);
        ASSERT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), mass, 4e-16 * mass);
        ASSERT_LE(masses.size(), std::min<std::size_t>(4, most) + 1);
        ASSERT_TRUE(std::is_sorted(masses.rbegin(), masses.rend()));
        if (masses.size() > 1) {
          ASSERT_NEAR(masses[0], largest * mass, 1e-12 * mass);
          ASSERT_GE(masses.back(), 1.0);
        }
      }
  EXPECT_EQ(piece_masses({.threshold = 1.0, .largest = 0.5, .where = {}}, 1e6, 16).size(), 5U);
  EXPECT_EQ(piece_masses({.threshold = 1.0, .largest = 0.9, .where = {}}, 9.0, 16).size(), 1U);  // 0.9 kg is too small
}

/// 500 kg are left for four pieces in the ratio 1 : 2^-1.2 : 3^-1.2 : 4^-1.2 = 1 : 0.435275 : 0.267581 : 0.189465,
/// whose sum is 1.892320. docs/effects.md, "fragmentation".
TEST(Fragmentation, MassesByRankByHand) {
  const std::vector<double> masses = piece_masses({.threshold = 1.0, .largest = 0.5, .where = {}}, 1000.0, 16);
  const std::vector<double> expected{500.0, 264.2259, 115.0110, 70.7017, 50.0614};
  ASSERT_EQ(masses.size(), expected.size());
  for (std::size_t i = 0; i < masses.size(); ++i) EXPECT_NEAR(masses[i], expected[i], 1e-3) << i;
}

TEST(Fragmentation, BreaksAboveItsThresholdOnly) {  // 20 m: 1/2 v^2 = 196.2 J/kg, k_n = 15 / (15 + c D v^2) = 0.1326
  for (const double threshold : {192.0, 193.5}) {
    Hillside hill(0.0);
    hill.cover.grounds[0] = {};
    hill.effects.fragmentation = {.threshold = threshold, .largest = 0.6, .where = {}};
    const double e = 0.25 * 2.0 * kGravity * 20.0, k = 15.0 / (15.0 + e);
    const Path path = hill.run(block_at({100.0, 400.0, 1020.0}, Vec3::Zero()));
    EXPECT_EQ(!path.breaks.empty(), kGravity * 20.0 * (1.0 - k * k) > threshold);
  }
}

struct Broken1 {
  Release release;
  Path path;
};

Broken1 broken(std::uint32_t block) {
  Hillside hill(0.6, 4.0, 200);
  hill.cover.grounds[0] = {.theta_scale = 0.6, .psi_scale = 0.5, .shape_max = 1.3};
  hill.effects.fragmentation = {.threshold = 100.0, .largest = 0.6, .where = {}};
  const Release release = block_at({60.0, 400.0, 1000.0}, {3.0, 0.5, 0.0}, 1.5, block);
  return {release, hill.run(release)};
}

TEST(Fragmentation, ConservesMassAndLosesOnePercentOfTheEnergy) {
  for (std::uint32_t block = 0; block < 50; ++block) {
    const auto [release, path] = broken(block);
    ASSERT_FALSE(path.breaks.empty());
    double pieces = 0.0;
    for (const Release& piece : path.pieces) pieces += piece.body.mass;
    EXPECT_NEAR(path.mass + pieces, release.body.mass, 1e-14 * release.body.mass);
    EXPECT_LE(path.pieces.size(), kMostPieces);
    for (const Release& piece : path.pieces) {  // the density stays
      const double d = piece.body.diameter;
      EXPECT_NEAR(piece.body.mass, 2700.0 * kPi / 6.0 * d * d * d, 1e-12 * piece.body.mass);
    }
    const Vertex& first = path.vertices[path.breaks[0].vertex];
    ASSERT_EQ(first.event, Event::Impact);
    double energy = 0.5 * path.breaks[0].body.mass * first.motion.velocity.squaredNorm();
    const double whole = 0.5 * release.body.mass * first.motion.velocity.squaredNorm();  // had all gone on together
    for (const Release& piece : path.pieces)
      if (piece.motion.time == first.motion.time) energy += 0.5 * piece.body.mass * piece.motion.velocity.squaredNorm();
    EXPECT_NEAR(energy, whole, 1e-12 * whole);
  }
}

TEST(Fragmentation, LosesOnePercentAgainstTheSameReboundUnbroken) {
  Hillside hill(0.6);
  const Release release = block_at({60.0, 400.0, 1000.0}, {3.0, 0.5, 0.0}, 1.5);
  const Path whole = hill.run(release);
  hill.effects.fragmentation = {.threshold = 100.0, .largest = 0.6, .where = {}};
  const Path path = hill.run(release);
  ASSERT_EQ(path.breaks.at(0).vertex, 1U);
  EXPECT_NEAR(path.vertices[1].motion.velocity.squaredNorm(), 0.99 * whole.vertices[1].motion.velocity.squaredNorm(),
              1e-10);
}

TEST(Fragmentation, PiecesFlyInTheirConeAndNotIntoTheGround) {
  const Vec3 normal = Vec3(0.6, 0.0, 1.0).normalized();
  test::Moments cosine;
  for (std::uint32_t block = 0; block < 2000; ++block) {
    Release release = block_at(Vec3::Zero(), Vec3::Zero(), 1.5, block);
    Motion motion;
    motion.velocity = 10.0 * normal;
    Block body = release.body;
    Path path;
    ASSERT_TRUE(break_up({.threshold = 1.0, .largest = 0.5, .where = {}}, release, normal, body, motion, path));
    for (const Release& piece : path.pieces) {
      const double c = piece.motion.velocity.normalized().dot(normal);
      ASSERT_GE(c, std::cos(radians(25.0)) - 1e-12);
      cosine.add(c);
    }
  }
  const double low = std::cos(radians(25.0));  // even over the solid angle: the cosine is uniform
  EXPECT_NEAR(cosine.mean(), 0.5 * (1.0 + low), 5.0 * (1.0 - low) / std::sqrt(12.0 * cosine.count));
  Release release = block_at(Vec3::Zero(), Vec3::Zero(), 1.5);
  Motion motion;
  motion.velocity = Vec3(10.0, 0.0, -6.0);  // along the surface
  Block body = release.body;
  Path path;
  ASSERT_TRUE(break_up({.threshold = 1.0, .largest = 0.5, .where = {}}, release, normal, body, motion, path));
  for (const Release& piece : path.pieces) EXPECT_GE(piece.motion.velocity.dot(normal), -1e-12);
}

TEST(Fragmentation, PiecesAreTracedWithStreamsOfTheirOwnAndAtMostSixteen) {
  Hillside hill(0.8, 4.0, 200);
  hill.cover.grounds[0] = {.theta_scale = 0.6, .psi_scale = 0.5, .En50 = 5.0, .shape_max = 1.3};
  hill.effects.fragmentation = {.threshold = 60.0, .largest = 0.6, .where = {}};
  Release release = block_at({60.0, 400.0, 990.0}, {3.0, 0.5, 0.0}, 3.0);
  int broke_again = 0;
  for (std::uint32_t block = 0; block < 30; ++block) {
    release.block = block;
    const Path whole = hill.run(release);
    double mass = whole.mass;
    std::set<std::uint32_t> numbers;
    std::vector<Path> paths;
    trace_pieces(hill.world(), whole, [&](const Release& piece, const Path& path) {
      mass += path.mass;
      numbers.insert(piece.piece);
      for (const Path& other : paths) EXPECT_FALSE(same_bits(path, other));
      paths.push_back(path);
    });
    EXPECT_NEAR(mass, release.body.mass, 1e-13 * release.body.mass) << block;
    if (numbers.size() > whole.pieces.size()) ++broke_again;
    EXPECT_LE(numbers.size(), kMostPieces);
    if (numbers.empty()) continue;
    EXPECT_EQ(*numbers.begin(), 1U);
    EXPECT_EQ(*numbers.rbegin(), numbers.size());
  }
  EXPECT_GT(broke_again, 5);
}

/// A block of 4 m breaks where it lands; the rest then hops over ground that takes nothing, 1.2 m in 1.8 s. At the
/// third contact, 5.4 s and 3.6 m from the break, it is farther than its diameter (0.5^(1/3) 4 m = 3.17 m) and goes on;
/// a whole block would not be, and would have stayed.
TEST(Fragmentation, WhatIsLeftStaysByItsOwnDiameter) {
  const double hop = 1.2, time = 1.8, kept = std::sqrt(kBreakKeeps), fall = std::sqrt(2.0 * kGravity * 10.0);
  const double k_n = 0.5 * kGravity * time / (kept * fall), energy = 0.25 * 4.0 * fall * fall;
  Hillside hill(0.0, 4.0, 20);
  hill.rules.trap_time = 5.0 / std::sqrt(4.0 / 2.0);  // 5 s for the whole block
  Ground smooth = test::kPerfect, hard = test::kPerfect;
  smooth.tan_phi = hard.tan_phi = 0.0;
  hard.En50 = energy * k_n / (1.0 - k_n);  // k_n = En50 / (En50 + c D v^2)
  hill.cover.grounds = {smooth, hard};
  hill.cover.zones = Raster<std::uint8_t>(hill.surface.grid(), 0);
  hill.cover.zones.at(4, 10) = 1;  // x from 16 to 20 m
  Release release = block_at({19.9, 42.0, 1010.0}, {hop / time / kept, 0.0, 0.0}, 4.0);
  release.motion.position.x() -= release.motion.velocity.x() * fall / kGravity;
  release.pieces_left = 4;

  const Path whole = hill.run(release);
  EXPECT_EQ(whole.end, End::Stopped);
  hill.effects.fragmentation = {.threshold = 10.0, .largest = 0.5, .where = {}};
  const Path path = hill.run(release);
  ASSERT_EQ(path.breaks.size(), 1U);
  EXPECT_NEAR(path.breaks[0].body.diameter, 4.0 * std::cbrt(0.5), 1e-12);
  EXPECT_NEAR(path.vertices[4].motion.position.x() - path.vertices[1].motion.position.x(), 3.0 * hop, 1e-9);
  EXPECT_NEAR(path.vertices[4].motion.time - path.vertices[1].motion.time, 3.0 * time, 1e-9);
  EXPECT_EQ(path.end, End::Left);

  Release alone = release;  // the same piece, released where it broke
  alone.body = path.breaks[0].body;
  alone.motion = path.vertices[1].motion;
  alone.pieces_left = 0;
  const Path same = hill.run(alone);
  EXPECT_EQ(same.end, path.end);
  EXPECT_LT((same.vertices.back().motion.position - path.vertices.back().motion.position).norm(), 1e-6);
}

}  // namespace
}  // namespace talus
