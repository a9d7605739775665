#include "talus/physics/effects/rest_in_roughness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "support/slopes.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;

constexpr double kTan35 = 0.70020753820970978;

Vec3 normal_at(double degrees) {
  const double angle = degrees * kPi / 180.0;
  return {0.6 * std::sin(angle), -0.8 * std::sin(angle), std::cos(angle)};
}

double tangent(double degrees) {
  return std::tan(degrees * kPi / 180.0);
}

/// Whether a block of D = 1.2 m with this speed stays on flat ground behind an asperity of tan(theta) = 0.5.
bool stays(double kappa, double speed, double diameter = 1.2) {
  const Ground ground{.tan_phi = 0.5};
  const Block block = block_of(diameter, 2700.0);
  const Asperity asperity{.tan_theta = 0.5};
  const Vec3 velocity = speed * Vec3(0.36, -0.48, 0.8), up = Vec3::UnitZ();
  return RestInRoughness{.kappa = kappa, .where = {}}.holds({ground, block, velocity, up, asperity});
}

/// v^2 = 2 9.81 0.6 1.2 0.5 = 7.0632.
TEST(RestInRoughness, ThresholdOfTheSpeed) {
  constexpr double kThreshold = 2.6576681508420607;
  EXPECT_TRUE(stays(0.6, kThreshold * (1.0 - 1e-12)));
  EXPECT_FALSE(stays(0.6, kThreshold * (1.0 + 1e-12)));
  EXPECT_TRUE(stays(0.6, 2.0 * kThreshold * (1.0 - 1e-12), 4.8));  // grows as sqrt(D)
  EXPECT_FALSE(stays(0.6, 2.0 * kThreshold * (1.0 + 1e-12), 4.8));
  EXPECT_FALSE(stays(0.0, 0.0));
}

/// slope - theta <= phi, in angles.
TEST(RestInRoughness, LeansUpToFrictionAndAsperity) {
  for (const auto& [theta, phi] : {std::pair{5.0, 30.0}, {0.0, 30.0}, {20.0, 35.0}, {44.0, 45.0}}) {
    EXPECT_TRUE(leans(normal_at(theta + phi - 1e-9), tangent(theta), tangent(phi))) << theta << ' ' << phi;
    EXPECT_FALSE(leans(normal_at(theta + phi + 1e-9), tangent(theta), tangent(phi))) << theta << ' ' << phi;
  }
  EXPECT_TRUE(leans(normal_at(89.9), tangent(50.0), tangent(41.0)));  // 91 degrees hold on any slope
}

/// The path with the effect is the one without it up to the first impact where the rule holds, and ends there. The rule
/// is written anew, with angles, from the draws of the asperities.
TEST(RestInRoughness, EndsTheSamePathAtTheFirstImpactThatHoldsTheBlock) {
  constexpr double kKappa = 0.6;
  Hillside with(kTan35), without(kTan35);
  with.cover.grounds[0] = without.cover.grounds[0] = {.theta_scale = 1.0, .psi_scale = 0.9, .shape_max = 1.5};
  with.effects.rest_in_roughness.kappa = kKappa;
  without.acting = false;
  int held = 0;
  for (std::uint32_t block = 0; block < 100; ++block) {
    const Release release = block_at({41.0, 400.0, 975.0}, {1.0, 0.2, 0.0}, 1.2, block);
    const Path free = without.run(release), rests = with.run(release);
    Asperities asperities(Random(release.seed, release.source, release.block, Purpose::Impact, release.piece),
                          Roughness::Clamp);
    std::optional<std::size_t> stop;
    std::uint32_t impact = 0;
    for (std::size_t i = 0; i < free.vertices.size() && !stop; ++i) {
      if (free.vertices[i].event != Event::Impact) continue;
      const double theta = std::atan(asperities.at(impact++, with.cover.grounds[0]).tan_theta);
      const double height = free.vertices[i].motion.velocity.squaredNorm() / (2.0 * 9.81);
      if (height < kKappa * 1.2 * std::tan(theta) && 35.0 * kPi / 180.0 - theta <= kPi / 6.0) stop = i;
    }
    ASSERT_EQ(rests.vertices.size(), stop ? *stop + 2 : free.vertices.size()) << block;  // then the vertex of the end
    for (std::size_t i = 0; i + 1 < rests.vertices.size(); ++i) {
      ASSERT_EQ(rests.vertices[i].motion.position, free.vertices[i].motion.position) << block;
      ASSERT_EQ(rests.vertices[i].motion.velocity, free.vertices[i].motion.velocity) << block;
    }
    ASSERT_EQ(rests.end, stop ? End::Stopped : free.end) << block;
    held += stop ? 1 : 0;
  }
  EXPECT_GT(held, 20);
}

/// Share that stops on a plane of 35 degrees, steeper than phi.
double share_stopped(double kappa, double turn = 0.0) {
  Hillside hill(0.0);
  hill.surface = Surface(test::terrain(test::grid_of(120, 120, 5.0, 5.0), [turn](double x, double y) {
    return 1000.0 - kTan35 * (std::cos(turn) * (x - 300.0) + std::sin(turn) * (y - 300.0));
  }));
  hill.cover.grounds[0] = {.theta_scale = 1.0, .psi_scale = 0.9, .shape_max = 1.5};
  hill.effects.rest_in_roughness.kappa = kappa;
  int stopped = 0;
  constexpr int kBlocks = 1000;
  for (std::uint32_t block = 0; block < kBlocks; ++block)
    stopped += hill.run(block_at({300.0, 300.0, 1002.0}, Vec3::Zero(), 1.2, block)).end == End::Stopped ? 1 : 0;
  return static_cast<double>(stopped) / kBlocks;
}

TEST(RestInRoughness, MoreBlocksStopOnTalusTheLargerKappa) {
  const double none = share_stopped(0.0), some = share_stopped(0.3), more = share_stopped(1.2);
  EXPECT_LT(none, 0.01);
  EXPECT_GT(some, none + 0.02);
  EXPECT_GT(more, some + 0.1);
}

/// A terrain mirrored, or turned by any angle, holds the same share: five standard errors of the difference.
TEST(RestInRoughness, KnowsNoDirection) {
  const double east = share_stopped(0.3);
  const double error = std::sqrt(2.0 * east * (1.0 - east) / 1000.0);
  for (const double turn : {kPi, 0.5 * kPi, 1.0, -1.0})
    EXPECT_NEAR(share_stopped(0.3, turn), east, 5.0 * error) << turn;
}

}  // namespace
}  // namespace talus
