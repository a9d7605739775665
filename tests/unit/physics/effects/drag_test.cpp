#include <gtest/gtest.h>

#include "support/slopes.hpp"
#include "talus/physics/effects/air_drag.hpp"
#include "talus/physics/effects/damped_fall.hpp"
#include "talus/physics/effects/vegetation_drag.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;

TEST(DampedFall, SolvesItsEquation) {  // by 20 000 steps of the midpoint rule
  for (const double rate : {0.0, 1e-9, 0.02, 0.6, 5.0}) {
    Vec3 v(25.0, -3.0, 8.0), x = Vec3::Zero();
    constexpr int kSteps = 20'000;
    constexpr double kTime = 0.7, kStep = kTime / kSteps;
    const Vec3 start = v;
    const auto slope = [&](const Vec3& u) -> Vec3 { return -rate * u - Vec3(0.0, 0.0, kGravity); };
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 middle = v + 0.5 * kStep * slope(v);
      x += kStep * middle;
      v += kStep * slope(middle);
    }
    const DampedFall fall(rate, kTime);
    EXPECT_LT((fall.velocity_after(start) - v).norm(), 1e-7) << rate;
    const Vec3 end = kTime * fall.parabola(start) - Vec3(0.0, 0.0, 0.5 * kGravity * kTime * kTime);
    EXPECT_LT((end - x).norm(), 1e-7) << rate;
  }
  EXPECT_EQ(DampedFall(0.0, 0.7).parabola(Vec3(3.0, 4.0, 5.0)), Vec3(3.0, 4.0, 5.0));
}

TEST(AirDrag, DecelerationsOfTheDragEquation) {  // a/g at 30 m/s, C_d 0.47, 2700 kg/m^3: 14 % at 0.1 m, 1.4 % at 1 m
  const AirDrag drag{.coefficient = 0.47};
  EXPECT_NEAR(air_drag_rate(drag, block_of(0.1, 2700.0)) * 900.0 / kGravity, 0.1437, 1e-4);
  EXPECT_NEAR(air_drag_rate(drag, block_of(1.0, 2700.0)) * 900.0 / kGravity, 0.01437, 1e-5);
}

TEST(AirDrag, FallsAtItsTerminalSpeed) {  // v = sqrt(4 D rho_r g / (3 rho_a C_d))
  Hillside hill(0.0, 4.0, 20);
  hill.effects.air_drag.coefficient = 1.0;
  const double terminal = std::sqrt(4.0 * 0.05 * 2700.0 * kGravity / (3.0 * 1.2 * 1.0));
  const Path path = hill.run(block_at({40.0, 40.0, 3000.0}, Vec3::Zero(), 0.05));
  // From rest: z = u^2/g ln cosh(g t/u).
  const double u = terminal;
  std::size_t i = 1;
  for (; i + 1 < path.vertices.size() && path.vertices[i].event == Event::Air; ++i) {
    const Motion& m = path.vertices[i].motion;
    const double fallen = u * u / kGravity * std::log(std::cosh(kGravity * m.time / u));
    ASSERT_NEAR(3000.0 - m.position.z(), fallen, 1e-3 * fallen);
  }
  const Motion &last = path.vertices[i - 1].motion, &before = path.vertices[i - 2].motion;
  EXPECT_NEAR((before.position.z() - last.position.z()) / (last.time - before.time), terminal, 1e-4 * terminal);
}

/// Ground that sends a block back with the speed that it comes with.
constexpr Ground kMirror{.En50 = 1e300, .Et50 = 1e300, .tan_phi = 0.0};

const Motion& first_rebound(const Path& path) {
  return std::find_if(path.vertices.begin(), path.vertices.end(),
                      [](const Vertex& v) { return v.event == Event::Impact; })
      ->motion;
}

/// From rest v^2 = g/k (1 - exp(-2 k h)), k the loss per metre: in one piece of the flight, in several, and in a part
/// of one.
TEST(AirDrag, LandsAfterAFallFromRestAsTheClosedFormSays) {
  test::Numbers numbers(6);
  for (int i = 0; i < 300; ++i) {
    const double cell = std::pow(30.0, numbers.uniform(0.0, 1.0)),
                 height = 0.2 * std::pow(150.0, numbers.uniform(0, 1));
    Hillside hill(0.0, cell, 6);
    hill.cover.grounds[0] = kMirror;
    hill.effects.air_drag.coefficient = numbers.uniform(0.3, 3.0);
    const Release release = block_at({2.2 * cell, 2.3 * cell, 1000.0 + height}, Vec3::Zero(), numbers.uniform(0.05, 1));
    const double k = air_drag_rate(hill.effects.air_drag, release.body);
    const double speed = std::sqrt(-kGravity / k * std::expm1(-2.0 * k * height));
    ASSERT_NEAR(first_rebound(hill.run(release)).velocity.z(), speed, 2e-4 * speed)
        << cell << ' ' << height << ' ' << k;
  }
}

/// Thrown in any direction, against steps of the midpoint rule of 0.1 ms.
TEST(AirDrag, LandsAfterAThrowAsSmallStepsSay) {
  test::Numbers numbers(7);
  for (int i = 0; i < 200; ++i) {
    const double cell = std::pow(30.0, numbers.uniform(0.0, 1.0)), height = numbers.uniform(0.2, 30.0);
    Hillside hill(0.0, cell, 400);
    hill.cover.grounds[0] = kMirror;
    hill.effects.air_drag.coefficient = 1.0;
    Vec3 v(numbers.uniform(0.0, 40.0), 0.0, numbers.uniform(-5.0, 15.0)), x(2.2 * cell, 2.3 * cell, height);
    const Release release = block_at(x + Vec3(0, 0, 1000), v, numbers.uniform(0.05, 0.5));
    const double k = air_drag_rate(hill.effects.air_drag, release.body);
    const auto change = [&](const Vec3& u) -> Vec3 { return -k * u.norm() * u - Vec3(0.0, 0.0, kGravity); };
    for (constexpr double kStep = 1e-4; x.z() > 0.0;) {
      const Vec3 middle = v + 0.5 * kStep * change(v);
      const double step = middle.z() < 0.0 ? std::min(kStep, x.z() / -middle.z() + 1e-12) : kStep;  // to the ground
      x += step * middle;
      v += step * change(middle);
    }
    const Path path = hill.run(release);
    if (path.impacts == 0) continue;  // off the terrain
    const Motion& landed = first_rebound(path);
    const double way = x.x() - release.motion.position.x();
    ASSERT_LT((landed.velocity - Vec3(v.x(), v.y(), -v.z())).norm(), 1e-3 * v.norm()) << i;
    ASSERT_NEAR(landed.position.x(), x.x(), 2e-3 * (way + height)) << i;
  }
}

TEST(VegetationDrag, SpeedFallsLinearlyWithThePath) {  // dv/ds = -c/m: level way until the block has fallen 1 000 m
  Hillside hill(0.0);
  hill.effects.vegetation_drag = {.coefficient = 500.0, .height = 1e9, .where = {}};
  const Release release = block_at({10.0, 400.0, 9000.0}, {40.0, 0.0, 0.0}, 0.82);
  const double rate = 500.0 / release.body.mass;
  const Path path = hill.run(release);
  int checked = 0;
  for (std::size_t i = 2; i + 1 < path.vertices.size() && path.vertices[i].event == Event::Air; ++i, ++checked) {
    const Motion& m = path.vertices[i].motion;
    const double t = m.time;  // closed form of both components: e^-at, and the terminal speed g/a
    const double x = 10.0 + 40.0 / rate * (1.0 - std::exp(-rate * t));
    const double z = 9000.0 - kGravity / rate * (t - (1.0 - std::exp(-rate * t)) / rate);
    ASSERT_NEAR(m.position.x(), x, 1e-9);
    ASSERT_NEAR(m.position.z(), z, 1e-9);
  }
  EXPECT_GT(checked, 100);
}

/// When a block lands after a drop [m] under a drag of a [1/s]: Newton on drop = g/a (t - (1 - e^-at)/a) [s].
double landing(double drop, double a) {
  double t = std::sqrt(2.0 * drop / kGravity);
  for (int i = 0; i < 50; ++i) {
    const double e = std::exp(-a * t);
    t -= (kGravity / a * (t - (1.0 - e) / a) - drop) / (kGravity / a * (1.0 - e));
  }
  return t;
}

TEST(VegetationDrag, LandsWhereTheClosedFormSays) {  // hops shorter than a piece are the rule in a stand
  Hillside hill(0.0);
  hill.effects.vegetation_drag = {.coefficient = 500.0, .height = 100.0, .where = {}};
  for (const double drop : {0.05, 0.4, 3.0, 20.0}) {
    const Release release = block_at({10.0, 400.0, 1000.0 + drop}, {20.0, 0.0, 0.0}, 0.82);
    const double a = 500.0 / release.body.mass;
    const double t = landing(drop, a);
    const Path path = hill.run(release);
    const auto landed = std::find_if(path.vertices.begin(), path.vertices.end(),
                                     [](const Vertex& v) { return v.event == Event::Impact; });
    ASSERT_NE(landed, path.vertices.end());
    EXPECT_NEAR(landed->motion.time, t, 1e-4 * t) << drop;
    EXPECT_NEAR(landed->motion.position.x() - 10.0, 20.0 / a * (1.0 - std::exp(-a * t)), 1e-5 * 20.0 * t) << drop;
  }
}

/// In a search drag may take a fifth of the speed in one piece. Where the block lands is the same to millimetres, in
/// the undergrowth of a campaign (c/m of 0.64 1/s) and in one that holds nearly everything (6 1/s).
TEST(VegetationDrag, LongPiecesLandWhereTheClosedFormSays) {
  Hillside hill(0.0);
  for (const double coefficient : {500.0, 5000.0})
    for (const double drop : {0.05, 0.4, 3.0, 20.0}) {
      hill.effects.vegetation_drag = {.coefficient = coefficient, .height = 100.0, .where = {}};
      const Release release = block_at({10.0, 400.0, 1000.0 + drop}, {20.0, 0.0, 0.0}, 0.82);
      const double a = coefficient / release.body.mass;
      const double t = landing(drop, a);
      World world = hill.world();
      world.effort.drag_loss = 0.2;
      Path path;
      trace(world, release, path);
      const auto landed = std::find_if(path.vertices.begin(), path.vertices.end(),
                                       [](const Vertex& v) { return v.event == Event::Impact; });
      ASSERT_NE(landed, path.vertices.end());
      EXPECT_NEAR(landed->motion.time, t, 2e-3) << coefficient << ' ' << drop;
      EXPECT_NEAR(landed->motion.position.x() - 10.0, 20.0 / a * (1.0 - std::exp(-a * t)), 5e-3)
          << coefficient << ' ' << drop;
      EXPECT_LT(path.vertices.size(), hill.run(release).vertices.size());
    }
}

/// A block that creeps through dense growth for minutes ends at the bound of a search; one that needs fewer vertices is
/// the same, bit for bit.
TEST(Effort, EndsATrajectoryAtItsLimit) {
  Hillside hill(1.2);
  hill.cover.grounds = {Ground{.tan_phi = 0.5}};
  hill.effects.vegetation_drag = {.coefficient = 3000.0, .height = 10.0, .where = {}};
  const Release release = block_at({10.0, 400.0, 989.0}, {1.0, 0.0, 0.0}, 0.82);
  const Path whole = hill.run(release);
  ASSERT_GT(whole.vertices.size(), 2500U);
  World world = hill.world();
  Path path;
  world.effort.most_vertices = 1000;
  trace(world, release, path);
  EXPECT_EQ(path.end, End::Limit);
  EXPECT_GE(path.vertices.size(), 1000U);
  EXPECT_LT(path.vertices.size(), 2010U) << "what is under way ends: a slide has at most 1000 pieces";
  for (std::size_t i = 0; i < 1000; ++i) ASSERT_EQ(path.vertices[i].motion.time, whole.vertices[i].motion.time);
  world.effort.most_vertices = static_cast<std::uint32_t>(whole.vertices.size());
  trace(world, release, path);
  EXPECT_TRUE(test::same_bits(path, whole));
}

TEST(VegetationDrag, ActsInItsZoneAndBelowItsTopOnly) {
  Hillside hill(0.0, 4.0, 60);
  hill.cover.grounds = {Ground{}, Ground{}};
  hill.cover.zones = Raster<std::uint8_t>(hill.surface.grid(), 0);
  for (int row = 0; row < 60; ++row)
    for (int column = 20; column < 30; ++column) hill.cover.zones.at(column, row) = 1;  // x 80 to 120
  hill.effects.vegetation_drag = {.coefficient = 200.0, .height = 1e4, .where = {.zones = {0, 1}, .mask = {}}};
  const Release release = block_at({40.0, 120.0, 1100.0}, {50.0, 0.0, 20.0}, 1.0);
  const double rate = 200.0 / release.body.mass;
  const Path path = hill.run(release);
  for (const Vertex& v : path.vertices) {
    if (v.motion.position.x() < 80.0) {
      ASSERT_EQ(v.motion.velocity.x(), 50.0);
    }
    if (v.motion.position.x() > 124.0 && v.event == Event::Air) {  // 40 m at c/m per metre, to half a cell at the ends
      ASSERT_NEAR(v.motion.velocity.x(), 50.0 - 40.0 * rate, 4.0 * rate);
    }
  }
  hill.effects.vegetation_drag.height = 5.0;  // it flies over
  const Path above = hill.run(release);
  const auto landed = std::find_if(above.vertices.begin(), above.vertices.end(),
                                   [](const Vertex& v) { return v.event == Event::Impact; });
  EXPECT_EQ((landed - 1)->motion.velocity.x(), 50.0);
}

TEST(VegetationDrag, ABlockStuckInItEndsInTime) {
  Hillside hill(0.5);
  hill.effects.vegetation_drag = {.coefficient = 5000.0, .height = 1000.0, .where = {}};
  hill.rules.time_limit = 60.0;
  const Path path = hill.run(block_at({40.0, 400.0, 1010.0}, {10.0, 0.0, 0.0}, 0.1));
  EXPECT_LT(path.vertices.size(), 20'000U);
}

}  // namespace
}  // namespace talus
