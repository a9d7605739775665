#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/slopes.hpp"
#include "talus/physics/effects/block_mass.hpp"
#include "talus/physics/effects/block_shape.hpp"
#include "talus/physics/effects/rolling_resistance.hpp"
#include "talus/physics/effects/soft_ground.hpp"
#include "talus/physics/effects/wet_ground.hpp"
#include "talus/physics/slide.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;

TEST(BlockShape, FactorsOfTheIndex) {
  Block block = block_of(1.0, 2700.0);
  EXPECT_EQ(shape_index({}, block), 0.0);
  block.axes = Vec3(1.0, 0.8, 0.5);
  EXPECT_EQ(shape_index({}, block), 1.0);
  EXPECT_EQ(shape_scatter({.lateral = 0.6, .loss = 0.2, .where = {}}, block), 1.6);
  EXPECT_NEAR(shape_keeps({.lateral = 0.6, .loss = 0.2, .where = {}}, block), 0.8187307530779818, 1e-15);
}

/// The first impact of a block dropped with a level velocity on flat ground without friction.
Motion after_first_impact(const Hillside& hill, const Release& release) {
  const Path path = hill.run(release);
  for (const Vertex& v : path.vertices)
    if (v.event == Event::Impact) return v.motion;
  return {};
}

TEST(BlockShape, TakesTangentialSpeedAtAnImpact) {
  Hillside hill(0.0);
  hill.cover.grounds[0] = {.En50 = 15.0, .Et50 = 1e300, .tan_phi = 0.0};
  hill.effects.block_shape.loss = 0.5;
  Release release = block_at({100.0, 400.0, 1005.0}, {12.0, 0.0, 0.0});
  release.body.axes = Vec3(1.5, 1.2, 1.0);
  EXPECT_NEAR(after_first_impact(hill, release).velocity.x(), 12.0 * std::exp(-0.25), 1e-12);
}

/// The flattest block and the largest strengths that a scenario may have: L1/L3 is 10^6.
TEST(BlockShape, TheFlattestBlockStopsAtAFinitePlace) {
  Hillside hill(0.7, 5.0, 40);
  for (const double lateral : {0.0, 10.0})
    for (const double loss : {0.0, 5.0}) {
      hill.effects.block_shape = {.lateral = lateral, .loss = loss, .where = {}};
      for (std::uint32_t block = 0; block < 50; ++block) {
        Release release = block_at({50.0, 100.0, 970.0}, {3.0, 0.0, 0.0}, 1.0, block);
        release.body.axes = Vec3(1000.0, 1.0, 1e-3);
        for (const Vertex& v : hill.run(release).vertices)
          ASSERT_TRUE(v.motion.position.allFinite() && v.motion.velocity.allFinite()) << lateral << ' ' << loss;
      }
    }
}

TEST(BlockMass, PowersOfTheDiameter) {
  const BlockMass effect{.roughness = 0.5, .stiffness = 1.0, .reference_diameter = 1.0, .where = {}};
  EXPECT_NEAR(size_roughness(effect, block_of(4.0, 2700.0)), 0.5, 1e-15);
  EXPECT_NEAR(size_stiffness(effect, block_of(4.0, 2700.0)), 4.0, 1e-14);
  EXPECT_EQ(size_stiffness(effect, block_of(1.0, 2700.0)), 1.0);
}

TEST(BlockMass, StiffnessOneMakesAllSizesReboundAlike) {  // E_d = c D v^2 against En50 D
  Hillside hill(0.0);
  hill.cover.grounds[0] = {.En50 = 15.0, .Et50 = 1e300, .tan_phi = 0.0};
  hill.effects.block_mass.stiffness = 1.0;
  const double v2 = 2.0 * kGravity * 5.0, expected = std::sqrt(v2) * 15.0 / (15.0 + 0.25 * v2);
  for (const double diameter : {0.2, 1.0, 3.0})
    EXPECT_NEAR(after_first_impact(hill, block_at({100.0, 400.0, 1005.0}, Vec3::Zero(), diameter)).velocity.z(),
                expected, 1e-12);
}

TEST(WetGround, SoftensOnItsDaysInItsZone) {
  Hillside hill(0.0);
  hill.cover.grounds[0] = {.En50 = 15.0, .Et50 = 50.0, .tan_phi = 0.0};
  hill.effects.wet_ground = {.softening = 0.7, .drag = 0.4, .days = {3, 11}, .where = {}};
  const double e = 0.25 * 2.0 * kGravity * 5.0, v = std::sqrt(2.0 * kGravity * 5.0);
  for (const int day : {1, 3, 11}) {
    Release release = block_at({100.0, 400.0, 1005.0}, {12.0, 0.0, 0.0});
    release.day = day;
    const double n = day == 1 ? 15.0 : 15.0 * std::exp(-0.7), t = day == 1 ? 50.0 : 50.0 * std::exp(-0.4);
    const Motion after = after_first_impact(hill, release);
    EXPECT_NEAR(after.velocity.z(), v * n / (n + e), 1e-12) << day;
    EXPECT_NEAR(after.velocity.x(), 12.0 * t / (t + e), 1e-12) << day;
  }
}

TEST(SoftGround, DepthAndAreaOfTheLiterature) {
  Block block = block_of(0.82, 2700.0);
  block.mass = 780.0;
  const SoftGround soft{.drag = 2.5, .stiffness = 15.0, .scar_length = 1.5, .where = {}};
  EXPECT_NEAR(scar_depth(soft, block, 10.0), 0.1 * std::cbrt(780.0) * std::pow(15000.0, -0.4) * std::pow(10.0, 0.8),
              1e-12);
  EXPECT_NEAR(scar_depth(soft, block, 10.0), 0.124, 5e-4);  // Lu et al. (2019)
  EXPECT_EQ(scar_depth(soft, block, 1e3), block.radius());
  EXPECT_EQ(scar_depth(soft, block, 0.0), 0.0);
  for (const double d : {1e-6, 0.01, 0.15, 0.3, 0.4}) {
    const double r = 0.4;
    EXPECT_NEAR(segment_area(r, d), r * r * std::acos(1.0 - d / r) - (r - d) * std::sqrt(2.0 * r * d - d * d), 5e-15);
  }
  EXPECT_NEAR(segment_area(0.4, 0.4), 0.5 * kPi * 0.16, 1e-15);
}

TEST(SoftGround, TakesSpeedAlongTheGroundButNoSpin) {
  Hillside with(0.0), without(0.0);
  with.cover.grounds[0] = without.cover.grounds[0] = {.En50 = 15.0, .Et50 = 50.0, .tan_phi = 0.5};
  with.effects.soft_ground.drag = 2.5;
  without.acting = false;
  const Release release = block_at({100.0, 400.0, 1005.0}, {12.0, 3.0, 0.0});
  const Motion soft = after_first_impact(with, release), hard = after_first_impact(without, release);
  const double kept = scar_keeps(with.effects.soft_ground, release.body, std::sqrt(2.0 * kGravity * 5.0));
  EXPECT_LT(kept, 0.95);
  EXPECT_NEAR(soft.velocity.x(), kept * hard.velocity.x(), 1e-12);
  EXPECT_NEAR(soft.velocity.y(), kept * hard.velocity.y(), 1e-12);
  EXPECT_NEAR(soft.velocity.z(), hard.velocity.z(), 1e-12);
  EXPECT_EQ(soft.spin, hard.spin);
}

/// How far a block that rolls by small hops goes on a slope before it stops.
double way_of_rolling(double slope, double speed, double mu, double diameter) {
  Hillside hill(slope, 4.0, 200);
  hill.cover.grounds[0] = test::kPerfect;
  hill.effects.rolling_resistance = {.coefficient = mu, .hop = 0.5, .where = {}};
  hill.rules.trap_time = 3.0;
  const double cos_beta = 1.0 / std::sqrt(1.0 + slope * slope);
  const Vec3 along(cos_beta, 0.0, -slope * cos_beta), normal(slope * cos_beta, 0.0, cos_beta);
  Release release = block_at(Vec3(101.0, 401.0, 1000.0 - slope * 101.0), speed * along + 0.3 * normal, diameter);
  release.motion.spin = normal.cross(along) * (speed / release.body.radius());  // rolls: the contact is at rest
  const Path path = hill.run(release);
  EXPECT_EQ(path.end, End::Stopped);
  return (path.vertices.back().motion.position.x() - 101.0) / cos_beta;
}

TEST(RollingResistance, StopsWhereTheClosedFormSays) {  // v0^2 / (2 A g cos(theta) (mu - tan(theta))), A = 5/7
  for (const auto& [slope, mu] : {std::pair{0.0, 0.3}, {0.0, 0.6}, {0.25, 0.5}, {0.125, 0.3}})
    for (const double speed : {6.0, 12.0})
      for (const double diameter : {0.6, 2.0}) {
        const double cos_beta = 1.0 / std::sqrt(1.0 + slope * slope);
        const double expected = speed * speed / (2.0 * 5.0 / 7.0 * kGravity * cos_beta * (mu - slope));
        // Both act at the end of a hop of T = 2 v_n / (g cos): late by half a hop, and gravity by 1/2 g sin T^2 in
        // each.
        const double hop = 2.0 * 0.3 / (kGravity * cos_beta) * speed;
        const double late = 0.5 * hop * (1.0 + slope / (5.0 / 7.0 * (mu - slope)));
        EXPECT_NEAR(way_of_rolling(slope, speed, mu, diameter), expected + late, 0.01 * expected)
            << slope << ' ' << mu << ' ' << speed;
      }
}

TEST(RollingResistance, TakesNothingFromAHighHop) {
  EXPECT_TRUE(is_rolling({.coefficient = 0.5, .hop = 0.5, .where = {}}, 2.2, 1.0, 0.5));  // 0.247 m against 0.25 m
  EXPECT_FALSE(is_rolling({.coefficient = 0.5, .hop = 0.5, .where = {}}, 2.3, 1.0, 0.5));
  EXPECT_EQ(rolling_keeps({.coefficient = 0.7, .hop = 0.5, .where = {}}, 1.0, 3.0), 0.0);  // never reversing
  EXPECT_EQ(rolling_keeps({.coefficient = 0.7, .hop = 0.5, .where = {}}, 0.0, 0.0), 0.0);
  EXPECT_NEAR(rolling_keeps({.coefficient = 0.7, .hop = 0.5, .where = {}}, 4.0, 2.0), 0.75, 1e-15);
}

TEST(RollingResistance, AddsToTheFrictionOfASlide) {  // v^2 = 2 g cos(beta) (tan(phi) + mu - tan(beta)) d
  Hillside hill(0.25);
  hill.cover.grounds[0] = {.tan_phi = 0.3};
  hill.effects.rolling_resistance = {.coefficient = 0.2, .hop = 0.5, .where = {}};
  const double cos_beta = 1.0 / std::sqrt(1.0625);
  Motion motion;
  motion.position = {101.0, 401.0, 1000.0 - 0.25 * 101.0};
  motion.velocity = 1.5 * Vec3(cos_beta, 0.0, -0.25 * cos_beta);
  PatchIndex at = hill.surface.patch_at(101.0, 401.0);
  Path path;
  EXPECT_EQ(slide(hill.surface, hill.cover, motion, at, {5.0}, 1e-4, path, &hill.effects.rolling_resistance),
            SlideEnd::Stopped);
  EXPECT_NEAR(path.length, 1.5 * 1.5 / (2.0 * kGravity * cos_beta * 0.25), 1e-6);
}

}  // namespace
}  // namespace talus
