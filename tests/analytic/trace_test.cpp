#include "talus/physics/trace.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numeric>

#include "support/slopes.hpp"

namespace talus {
namespace {

using test::Numbers;

using test::kUpperTalus;

struct Launch {
  Surface surface;
  Cover cover;
  ImpactModel impact = {};
  EndRules rules = {};

  Path run(const Vec3& position, const Vec3& velocity, double diameter = 1.0, std::uint32_t block = 0) const {
    Path path;
    trace({surface, cover, impact, rules}, test::block_at(position, velocity, diameter, block), path);
    return path;
  }
};

Surface flat(double cell = 2.0, int n = 101) {
  return Surface(test::terrain(test::grid_of(n, n, cell, cell), [](double, double) { return 8.0; }));
}

/// Length of a hop straight up and down, in v^2/g, by the speeds at the three Gauss points of its time: 14 % too short,
/// as the block stands in the middle.
const double kGauss = 10.0 / 9.0 * std::sqrt(0.6);

TEST(BounceSeries,
     VerticalDropOnFlatGround) {  // v -> v E/(E + c D v^2), 2 v/g in the air, until it leaves below 0.5 m/s
  for (const double height : {2.0, 50.0})
    for (const double En50 : {5.0, 15.0}) {
      Launch scene{flat(), {{Ground{.En50 = En50}}, {}}};
      scene.rules.trap_time = 1e3;
      const Path path = scene.run({100.3, 99.1, 8.0 + height}, Vec3::Zero(), 1.2);
      double v = std::sqrt(2 * kGravity * height), t = v / kGravity, length = height;
      std::uint32_t impacts = 0;
      for (std::size_t i = 1; i + 1 < path.vertices.size(); ++i) {
        const Motion& m = path.vertices[i].motion;
        if (impacts > 0) {
          ASSERT_GE(v, 0.5);  // only the last one is slower
        }
        v *= En50 / (En50 + 0.25 * 1.2 * v * v);
        ++impacts;
        ASSERT_EQ(path.vertices[i].event, Event::Impact);
        ASSERT_NEAR(m.time, t, 1e-11);
        ASSERT_NEAR(m.velocity.z(), v, 1e-11);
        ASSERT_LT((m.position - Vec3(100.3, 99.1, 8.0)).norm(), 1e-12);
        t += 2 * v / kGravity;
        length += kGauss * v * v / kGravity;
      }
      EXPECT_EQ(path.end, End::Stopped);
      EXPECT_LT(v, 0.5);
      EXPECT_EQ(path.impacts, impacts);
      EXPECT_EQ(path.plan_length, 0.0);
      EXPECT_NEAR(path.length, length - kGauss * v * v / kGravity, 1e-9 * length);
    }
}

TEST(BounceSeries, ThrownAlongFlatGroundWithSpin) {  // independent recursion of Eqs. 3-6 in the plane of the motion
  const double tan_phi = 1.0 / std::sqrt(3.0), diameter = 1.2;
  const Launch scene{flat(2.0, 401), {{Ground{}}, {}}};
  for (const double turn : {0.0, 0.11, 0.77}) {
    const double c = std::cos(2 * kPi * turn), s = std::sin(2 * kPi * turn);
    const Path path = scene.run({400.3, 399.1, 11.0}, {12 * c, 12 * s, 0}, diameter);
    double v_t = 12.0, rim = 0.0, v_n = std::sqrt(6 * kGravity), x = v_t * v_n / kGravity, t = v_n / kGravity;
    int compared = 0;
    for (std::size_t i = 1; i < path.vertices.size() && path.vertices[i].event == Event::Impact; ++i) {
      const double energy = 0.25 * diameter * v_n * v_n, k_n = 15 / (15 + energy), k_t = 50 / (50 + energy);
      const double u = k_t * (v_t + rim), gamma = 2.0 / 7.0 * std::abs(u), limit = tan_phi * (1 + k_n) * v_n;
      const double j = std::copysign(std::min(gamma, limit), u);
      v_t = k_t * v_t - j, rim = k_t * rim - 2.5 * j, v_n = k_n * v_n;
      const Motion& m = path.vertices[i].motion;
      ASSERT_NEAR(m.time, t, 1e-10);
      ASSERT_LT((m.position - Vec3(400.3 + c * x, 399.1 + s * x, 8.0)).norm(), 1e-9);
      ASSERT_LT((m.velocity - Vec3(c * v_t, s * v_t, v_n)).norm(), 1e-11);
      ASSERT_LT((m.spin - rim / (0.5 * diameter) * Vec3(s, -c, 0)).norm(), 1e-11);  // axis t x n
      ++compared;
      if (v_n < kSlideSpeed) break;
      x += v_t * 2 * v_n / kGravity, t += 2 * v_n / kGravity;
    }
    EXPECT_GT(compared, 100);
    EXPECT_EQ(path.end, End::Stopped);
  }
}

TEST(Trap, APitWithWallsSteeperThanPhiHoldsItsBlockAndTellsSo) {
  const Surface pit(test::terrain(test::grid_of(61, 61, 2.0, 2.0), [](double x, double y) {
    return 0.75 * std::max(std::abs(x - 61), std::abs(y - 61));
  }));
  const Launch scene{pit, {{kUpperTalus}, {}}, {}, {.impact_limit = 2000}};
  int stopped = 0, trapped = 0;
  for (std::uint32_t block = 0; block < 200; ++block) {
    const Path path = scene.run({70.0, 75.0, 20.0}, Vec3::Zero(), 0.8, block);
    stopped += path.end == End::Stopped ? 1 : 0;
    trapped += path.end == End::Trapped ? 1 : 0;
    EXPECT_LT(path.vertices.back().motion.time, 120.0);
    EXPECT_LT(path.vertices.back().motion.position.z(), 20.0);  // lower than the release
    EXPECT_LT(path.vertices.size(), 5000U);
  }
  EXPECT_EQ(stopped + trapped, 200);
  EXPECT_GT(trapped, 180);  // the patch of a corner of the bottom is flat at its far end
}

/// On an open plane just steeper than phi a large block may go less than its diameter in `trap_time`, without any wall:
/// that is no trap.
TEST(Trap, ABlockThatCrawlsOnOpenGroundHasStopped) {
  const double slope = std::tan(radians(30.5));
  const Surface plane(
      test::terrain(test::grid_of(200, 60, 4.0, 4.0), [&](double x, double) { return 2000.0 - slope * x; }));
  const Launch scene{plane, {{kUpperTalus}, {}}};
  int stopped = 0;
  for (std::uint32_t block = 0; block < 200; ++block) {
    const Path path = scene.run({20.0, 120.0, *plane.height(20.0, 120.0) + 2.0}, Vec3::Zero(), 4.0, block);
    EXPECT_NE(path.end, End::Trapped) << block;
    stopped += path.end == End::Stopped ? 1 : 0;
  }
  EXPECT_GT(stopped, 0);
}

/// On a smooth plane steeper than phi v^2 = 2 g (sin b - tan(phi) cos b) s grows with the way s: nothing can hold a
/// block, however large, that starts from rest and needs long to get one diameter away.
TEST(Trap, ALargeBlockThatSpeedsUpOnOpenGroundLeaves) {
  const double slope = std::tan(radians(33.0));
  const Surface plane(
      test::terrain(test::grid_of(200, 60, 4.0, 4.0), [&](double x, double) { return 2000.0 - slope * x; }));
  const Launch scene{plane, {{Ground{.theta_scale = 0.0, .psi_scale = 0.0, .En50 = 15.0}}, {}}};
  for (const double diameter : {1.0, 4.0, 10.0, 30.0}) {
    const Path path = scene.run({20.0, 120.0, *plane.height(20.0, 120.0)}, Vec3::Zero(), diameter);
    EXPECT_EQ(path.end, End::Left) << diameter;
  }
}

/// A pit, a V and a hip whose sides all have one slope: the heights |x| and |y| are planes between cell centres. Where
/// the sides are steeper than phi, the pit and the V trap every block and the hip holds none; else every block that
/// stays has stopped, pit or not.
TEST(Trap, IsAnEndOfItsOwnOnlyBetweenWallsSteeperThanPhi) {
  enum class Shape { Pit, V, Hip };
  for (const Shape shape : {Shape::Pit, Shape::V, Shape::Hip})
    for (const double slope : {0.5, 0.75}) {  // tan(phi) = 0.577
      const double side = shape == Shape::V ? slope : slope / std::sqrt(2.0);
      const auto height = [&](double x, double y) {
        const double across = side * std::abs(y - 61.0), along = side * std::abs(x - 61.0);
        return 100.0 + (shape == Shape::Pit ? across + along : shape == Shape::V ? across : -across - along);
      };
      const Launch scene{Surface(test::terrain(test::grid_of(61, 61, 2.0, 2.0), height)), {{kUpperTalus}, {}}};
      std::array<int, kEnds> ends{};
      for (std::uint32_t block = 0; block < 100; ++block) {
        const Path path = scene.run({65.0, 68.0, height(65.0, 68.0) + 2.0}, Vec3::Zero(), 0.8, block);
        ++ends[static_cast<std::size_t>(path.end)];
      }
      const int stopped = ends[static_cast<std::size_t>(End::Stopped)],
                trapped = ends[static_cast<std::size_t>(End::Trapped)],
                left = ends[static_cast<std::size_t>(End::Left)];
      EXPECT_EQ(stopped + trapped + left, 100) << static_cast<int>(shape);
      EXPECT_EQ(trapped, slope > 0.577 && shape != Shape::Hip ? 100 : 0) << static_cast<int>(shape) << ' ' << slope;
      if (slope > 0.577)
        EXPECT_EQ(stopped, 0) << static_cast<int>(shape);
      else if (shape != Shape::Hip)
        EXPECT_EQ(stopped, 100) << static_cast<int>(shape);
    }
}

TEST(Trap,
     ABlockThatHopsOnOnePlaceIsTrappedAtTheFirstContactAfterThePatience) {  // k_n = 1: every hop takes 2 sqrt(2 h/g)
  Launch scene{flat(), {{Ground{.En50 = 1e300}}, {}}};
  for (const double patience : {2.0, 5.0, 11.0}) {
    scene.rules.trap_time = patience;
    const Path path = scene.run({100.3, 99.1, 9.0}, Vec3::Zero());
    const double fall = std::sqrt(2.0 / kGravity), hops = std::ceil(patience / (2 * fall));
    EXPECT_EQ(path.end, End::Stopped);  // on flat ground: what is held is not held by walls
    EXPECT_NEAR(path.vertices.back().motion.time, fall + hops * 2 * fall, 1e-9);
  }
}

/// Slopes of 33 degrees above and below a vertical wall of 100 m, cells of 1 m: in plan a block of 4 m is at the foot
/// of the wall still within its diameter from the edge, 4.5 s later. It has not stayed there: it arrives with sqrt(2 g
/// 100 m) = 44.3 m/s, and a block that has had no more than one diameter to fall in has v^2 <= 2 g D.
TEST(Trap, AFallDownAWallIsNoStay) {
  const double wall = 100.0, diameter = 4.0, speed = std::sqrt(2.0 * kGravity * wall);
  const Surface surface(test::terrain(test::grid_of(200, 60, 1.0, 1.0),
                                      [&](double x, double) { return 1000.0 - 0.65 * x - (x > 60.0 ? wall : 0.0); }));
  Launch scene{surface, {{kUpperTalus}, {}}};
  scene.rules.trap_time = 5.0 / std::sqrt(diameter / 2.0);  // 5 s for this block
  int fell = 0, stays = 0;
  for (std::uint32_t block = 0; block < 2000; ++block) {
    const double x = 59.5 - 0.02 * (block % 100);
    const Path path = scene.run({x, 30.0, *surface.height(x, 30.0) + 0.5}, Vec3::Zero(), diameter, block);
    for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
      const Motion &from = path.vertices[i].motion, &to = path.vertices[i + 1].motion;
      if (from.position.z() - to.position.z() < 0.9 * wall) continue;
      ++fell;
      EXPECT_EQ(path.vertices[i + 1].event, Event::Impact) << block;
      EXPECT_NEAR(kGravity * (to.time - from.time) - from.velocity.z(), speed, 0.1 * speed) << block;
    }
    if (!rests(path.end)) continue;
    ++stays;
    EXPECT_LE(path.vertices.back().motion.velocity.squaredNorm(), 2.0 * kGravity * diameter) << block;
  }
  EXPECT_GT(fell, 1000);
  EXPECT_GT(stays, 20);
}

TEST(Trap, AFoldSteeperThanPhiEndsSoon) {  // crossings of the bottom of a gully or a pit shrink without end (Zeno)
  for (const double along : {0.0, 0.25, 1.0})
    for (const Ground& ground : {Ground{}, kUpperTalus}) {
      const Surface gully(test::terrain(test::grid_of(61, 61, 2.0, 2.0),
                                        [&](double x, double y) { return 2.0 * std::abs(y - 61) - along * x; }));
      const Surface pit(test::terrain(test::grid_of(61, 61, 2.0, 2.0),
                                      [](double x, double y) { return 2.0 * (std::abs(x - 61) + std::abs(y - 61)); }));
      for (const Surface& surface : {gully, pit}) {
        const Launch scene{surface, {{ground}, {}}, {}, {.impact_limit = 3000}};
        for (std::uint32_t block = 0; block < 20; ++block) {
          const double x = 60.3 + 0.1 * block, y = 61.4 - 0.05 * block;
          const Path path = scene.run({x, y, *surface.height(x, y) + 3.0}, Vec3::Zero(), 1.0, block);
          ASSERT_LT(path.vertices.size(), 20'000U) << "along " << along << " block " << block;
          ASSERT_NE(path.end, End::Limit) << "along " << along << " block " << block;
        }
      }
    }
}

TEST(Trap, AFoldThatFallsSteeperThanPhiHoldsNoBlock) {  // walls 2:1, the bottom itself at 45 degrees
  const Surface gully(test::terrain(test::grid_of(61, 61, 2.0, 2.0),
                                    [&](double x, double y) { return 200.0 + 2.0 * std::abs(y - 61) - x; }));
  const Launch scene{gully, {{Ground{}}, {}}, {}, {.impact_limit = 3000}};
  for (std::uint32_t block = 0; block < 20; ++block) {
    const double y = 61.4 - 0.05 * block;
    EXPECT_EQ(scene.run({30.3, y, *gully.height(30.3, y) + 3.0}, Vec3::Zero(), 1.0, block).end, End::Left) << block;
  }
}

TEST(Limits, AreReachedAndSaid) {
  const Surface slope(test::terrain(test::grid_of(400, 41, 5.0, 5.0), [](double x, double) { return 3000.0 - x; }));
  Launch scene{slope, {{Ground{}}, {}}};
  scene.rules.impact_limit = 7;
  const Path path = scene.run({100.0, 100.0, 2950.0}, Vec3::Zero());
  EXPECT_EQ(path.end, End::Limit);
  EXPECT_EQ(path.impacts, 7U);
  scene.rules = {};
  scene.rules.time_limit = 9.0;
  const Path timed = scene.run({100.0, 100.0, 2950.0}, Vec3::Zero());
  EXPECT_EQ(timed.end, End::Limit);
  EXPECT_GE(timed.vertices.back().motion.time, 9.0);
}

TEST(Start, AtRestOnTheGround) {
  EXPECT_EQ((Launch{flat(), {{kUpperTalus}, {}}}.run({100.3, 99.1, 8.0}, Vec3::Zero()).end), End::Stopped);
  EXPECT_EQ((Launch{flat(), {{kUpperTalus}, {}}}.run({101.0, 101.0, 7.0}, Vec3::Zero()).end),
            End::Stopped);  // a little below it
  EXPECT_EQ((Launch{flat(), {{kUpperTalus}, {}}}.run({-5.0, 99.1, 8.0}, Vec3::Zero()).end), End::Left);
}

TEST(Start, NaNEndsAtOnce) {
  const double nan = std::nan("");
  const Launch scene{flat(), {{kUpperTalus}, {}}};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 velocity = Vec3::Zero();
    velocity[axis] = nan;
    EXPECT_LT(scene.run({100.3, 99.1, 10.0}, velocity).vertices.size(), 10U) << axis;
  }
  EXPECT_LT(scene.run({100.3, 99.1, nan}, Vec3::Zero()).vertices.size(), 10U);
}

/// Checks that a path in an odd scene is finite, ends and has no gaps.
void expect_sound(const Launch& scene, const Path& path) {
  ASSERT_GE(path.vertices.size(), 2U);
  ASSERT_EQ(path.vertices.front().event, Event::Release);
  ASSERT_EQ(path.vertices.back().event, Event::End);
  std::uint32_t impacts = 0, span_impacts = 0;
  for (std::size_t i = 0; i < path.vertices.size(); ++i) {
    const Motion& m = path.vertices[i].motion;
    ASSERT_TRUE(m.position.allFinite() && m.velocity.allFinite() && m.spin.allFinite() && std::isfinite(m.time));
    if (i > 0) {
      ASSERT_GE(m.time, path.vertices[i - 1].motion.time - 1e-12);
    }
    impacts += path.vertices[i].event == Event::Impact ? 1U : 0U;
    if (i > 0 && i + 1 < path.vertices.size()) {  // all but the release and the end are on the ground
      const double z = test::height_between_centres(scene.surface.heights(), m.position.x(), m.position.y());
      if (std::isfinite(z)) {
        ASSERT_NEAR(m.position.z(), z, 1e-6 * (1 + std::abs(z)));
      }
    }
  }
  for (const Span& s : path.spans) {
    span_impacts += s.impacts;
    for (const float x : {s.p_from, s.q_from, s.p_to, s.q_to}) ASSERT_TRUE(x > -1e-3F && x < 1.001F);
    for (const float x : {s.height_from, s.height_to, s.bend, s.rise_from, s.rise_to}) ASSERT_TRUE(std::isfinite(x));
    ASSERT_TRUE(s.height_from >= 0.0F && s.height_to >= 0.0F);
  }
  ASSERT_EQ(impacts, path.impacts);
  ASSERT_EQ(span_impacts, path.impacts);
  ASSERT_LE(path.plan_length, path.length * (1 + 1e-9) + 1e-12);
}

TEST(OddScenes, EveryPathEndsAndTheEndsAddUp) {
  Numbers numbers(5);
  std::array<int, kEnds> ends{};
  int released = 0;
  for (const double cell : {0.5, 2.0, 25.0})
    for (int kind = 0; kind < 5; ++kind) {
      Raster<float> heights =
          test::terrain(test::grid_of(60, 50, cell, cell * (kind == 4 ? 2.0 : 1.0)), [&](double x, double y) {
            const double u = x / cell, v = y / cell;
            switch (kind) {
              case 0:
                return 8.0;  // flat
              case 1:
                return cell * numbers.uniform(0, 3);  // a field of spikes
              case 2:
                return std::floor(u / 10.0) * 500.0;  // walls of 500 m
              case 3:
                return cell * 2.0 * std::abs(v - 25.2) - cell * 0.2 * u;  // a gully
              default:
                return -0.8 * x + cell * numbers.uniform(0, 1);  // a rough slope
            }
          });
      if (kind == 4) heights.at(40, 20) = std::numeric_limits<float>::quiet_NaN();
      const Launch scene{Surface(heights, SurfaceKind::Bilinear), {{kUpperTalus}, {}}, {}, {.impact_limit = 1000}};
      for (std::uint32_t block = 0; block < 60; ++block) {
        const bool centre = block % 3 == 0;  // exactly at a cell centre, as sources are
        const int column = static_cast<int>(numbers.uniform(5, 55)), row = static_cast<int>(numbers.uniform(5, 45));
        const double x = centre ? heights.grid.centre_x(column) : numbers.uniform(0.1, 0.9) * heights.grid.width();
        const double y = centre ? heights.grid.centre_y(row) : numbers.uniform(0.1, 0.9) * heights.grid.height();
        const double z = test::height_between_centres(heights, x, y);
        if (!std::isfinite(z)) continue;
        const Vec3 velocity = block % 4 == 0 ? Vec3(Vec3::Zero()) : numbers.vector(5.0);
        const Path path =
            scene.run({x, y, z + (block % 5 == 0 ? 0.0 : 2.0)}, velocity, numbers.uniform(0.2, 3.0), block);
        expect_sound(scene, path);
        if (HasFatalFailure()) FAIL() << "cell " << cell << " kind " << kind << " block " << block;
        ++ends[static_cast<std::size_t>(path.end)];
        ++released;
      }
    }
  const auto count = [&ends](End end) { return ends[static_cast<std::size_t>(end)]; };
  EXPECT_EQ(std::accumulate(ends.begin(), ends.end(), 0), released);
  EXPECT_GT(count(End::Stopped), 50);
  EXPECT_GT(count(End::Trapped), 50);
  EXPECT_GT(count(End::Left), 50);
  EXPECT_EQ(ends[static_cast<std::size_t>(End::Limit)], 0);
}

TEST(Trace, ClearsTheBufferAndGivesTheSameBits) {
  const Surface slope(
      test::terrain(test::grid_of(200, 60, 2.0, 2.0), [](double x, double) { return 300.0 - 0.75 * x; }));
  const Launch scene{slope, {{kUpperTalus}, {}}};
  const Path one = scene.run({20.3, 60.1, 290.0}, Vec3::Zero(), 1.0, 3);
  Path two = scene.run({20.3, 60.1, 290.0}, Vec3::Zero(), 1.0, 4);
  Release release;
  release.block = 3;
  release.body = block_of(1.0, 2700.0);
  release.motion.position = {20.3, 60.1, 290.0};
  trace({scene.surface, scene.cover, scene.impact, scene.rules}, release, two);
  ASSERT_EQ(one.vertices.size(), two.vertices.size());
  for (std::size_t i = 0; i < one.vertices.size(); ++i)
    EXPECT_EQ(one.vertices[i].motion.position, two.vertices[i].motion.position);
  EXPECT_EQ(one.length, two.length);
  EXPECT_EQ(one.impacts, two.impacts);
}

}  // namespace
}  // namespace talus
