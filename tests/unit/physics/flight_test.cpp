#include "talus/physics/flight.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace talus {
namespace {

using test::Numbers;

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(FirstContact, HandSolvedParabolas) {
  EXPECT_NEAR(first_contact(6.0, 1.0, -1.0, kNever), 3.0, 1e-15);  // (3 - t)(2 + t)
  EXPECT_NEAR(first_contact(6.0, -5.0, 1.0, kNever), 2.0, 1e-15);  // (t - 2)(t - 3): the first of two
  EXPECT_NEAR(first_contact(6.0, -2.0, 0.0, kNever), 3.0, 1e-15);  // straight down
  EXPECT_EQ(first_contact(6.0, -5.0, 1.0, 1.99), kNever);          // not yet
  EXPECT_NEAR(first_contact(6.0, -5.0, 1.0, 2.01), 2.0, 1e-15);
  EXPECT_EQ(first_contact(6.0, 1.0, -1.0, 2.99), kNever);
}

TEST(FirstContact, TakesThePreciseRootWhereRootsCancel) {
  // (1 - t)(t + 1e8) and (t - 1e-8)(t - 1e8): the textbook formula loses all digits of the small root
  EXPECT_NEAR(first_contact(1e8, 1.0 - 1e8, -1.0, kNever), 1.0, 4 * test::kEps);
  EXPECT_NEAR(first_contact(1.0, -(1e8 + 1e-8), 1.0, kNever) / 1e-8, 1.0, 4 * test::kEps);
}

TEST(FirstContact, AgainstLongDoubleRoots) {
  Numbers numbers(1);
  int met = 0;
  double worst = 0.0;
  for (int i = 0; i < 300'000; ++i) {
    const double f0 = std::pow(10.0, numbers.uniform(-6, 3)), f1 = numbers.uniform(-30, 30),
                 f2 = numbers.uniform(-8, 3);
    const long double disc = static_cast<long double>(f1) * f1 - 4.0L * f2 * f0;
    if (disc < 0.1L * f1 * f1) continue;  // nearly touching: rounding of the discriminant counts
    const long double sum = -0.5L * (f1 + std::copysign(std::sqrt(disc), static_cast<long double>(f1))), a = sum / f2,
                      b = f0 / sum;
    const long double low = std::min(a, b), high = std::max(a, b),
                      exact = low > 0.0L ? low : high;  // smallest positive
    const double got = first_contact(f0, f1, f2, kNever);
    if (!(exact > 0.0L)) {
      ASSERT_EQ(got, kNever) << f0 << ' ' << f1 << ' ' << f2;
      continue;
    }
    worst = std::max(worst, std::abs(static_cast<double>(got / exact - 1.0L)));
    ASSERT_EQ(first_contact(f0, f1, f2, 0.999999 * got), kNever);
    ASSERT_EQ(first_contact(f0, f1, f2, 1.000001 * got), got);
    ++met;
  }
  EXPECT_GT(met, 200'000);
  EXPECT_LT(worst, 16 * test::kEps);  // 4 eps, and the discriminant's at the bound above
}

TEST(FirstContact, FromTheGround) {
  EXPECT_EQ(first_contact(0.0, -1.0, -1.0, 5.0), 0.0);             // pressed into it
  EXPECT_NEAR(first_contact(0.0, 4.0, -2.0, kNever), 2.0, 1e-15);  // thrown up
  EXPECT_EQ(first_contact(0.0, 4.0, -2.0, 1.0), kNever);
  EXPECT_EQ(first_contact(0.0, 4.0, -2.0, 0.0), kNever);  // rises: on an edge it must not land at once
  EXPECT_EQ(first_contact(0.0, 4.0, 0.0, kNever), kNever);
  EXPECT_EQ(first_contact(0.0, 4.0, 3.0, kNever), kNever);
  EXPECT_EQ(first_contact(0.0, 0.0, 3.0, kNever), kNever);  // the ground falls away faster than the parabola
  EXPECT_EQ(first_contact(0.0, 0.0, -3.0, kNever), 0.0);
}

TEST(FirstContact, DoesNotTunnelWhereTheEndIsBelowTheGround) {
  Numbers numbers(2);
  for (int i = 0; i < 200'000; ++i) {
    const double f0 = numbers.uniform(0, 2), f1 = numbers.uniform(-5, 5), f2 = numbers.uniform(-6, 0),
                 until = numbers.uniform(0, 3);
    const double contact = first_contact(f0, f1, f2, until);
    const double last = f0 + until * (f1 + until * f2);
    if (last < 0.0) {
      ASSERT_LE(contact, until);
    }
    if (last > 0.0) {
      ASSERT_EQ(contact, kNever);
    }
  }
}

TEST(FirstContact, NeverWithoutARoot) {
  EXPECT_EQ(first_contact(1.0, 0.0, 1.0, kNever), kNever);
  EXPECT_EQ(first_contact(1.0, -1.0, 1.0, kNever), kNever);
  EXPECT_EQ(first_contact(1.0, 0.0, 0.0, kNever), kNever);
  EXPECT_EQ(first_contact(1.0, 2.0, 0.0, kNever), kNever);
}

TEST(FirstContact, NaNIsNever) {
  const double nan = std::nan("");
  EXPECT_EQ(first_contact(nan, -1.0, -1.0, 5.0), kNever);
  EXPECT_EQ(first_contact(1.0, nan, -1.0, 5.0), kNever);
  EXPECT_EQ(first_contact(1.0, -1.0, nan, 5.0), kNever);
  EXPECT_EQ(first_contact(1.0, -1.0, -1.0, nan), kNever);
}

/// A flight from a state: the engine's, with what came of it.
struct Flight {
  Motion motion;
  PatchIndex at;
  Path path;
  FlightEnd end;

  Flight(const Surface& surface, const Vec3& position, const Vec3& velocity, bool grounded = false) : path() {
    motion.position = position;
    motion.velocity = velocity;
    at = surface.patch_at(position.x(), position.y());
    end = fly(surface, motion, at, grounded, path);
  }
};

TEST(Fly, LandsOnAPlaneWhereTheClosedFormSaysInEveryDirection) {
  const double east = -0.75, north = 0.25;  // exact in floats
  const auto plane = [&](double x, double y) { return 1000.0 + east * x + north * y; };
  const Surface surface(test::terrain(test::grid_of(200, 100, 2.0, 4.0), plane));
  for (int direction = 0; direction < 72; ++direction)
    for (const double start : {200.0, 201.0, 200.37})  // 201 is a grid line, with y = 202 a corner
      for (const double up : {-3.0, 0.0, 6.0}) {
        const double turn = 2 * kPi * direction / 72.0, vx = 11.0 * std::cos(turn), vy = 11.0 * std::sin(turn);
        const double h = 5.0, y = 202.0;
        const Flight f(surface, {start, y, plane(start, y) + h}, {vx, vy, up});
        // h + (up - slope . v) t - g/2 t^2 = 0
        const double rate = up - east * vx - north * vy,
                     t = (rate + std::sqrt(rate * rate + 2 * kGravity * h)) / kGravity;
        ASSERT_EQ(f.end, FlightEnd::Landed);
        EXPECT_NEAR(f.motion.time, t, 1e-12);
        EXPECT_LT((f.motion.position - Vec3(start + vx * t, y + vy * t, plane(start + vx * t, y + vy * t))).norm(),
                  1e-10);
        EXPECT_LT((f.motion.velocity - Vec3(vx, vy, up - kGravity * t)).norm(), 1e-12);
        EXPECT_NEAR(f.path.plan_length, 11.0 * t, 1e-11);
      }
}

TEST(Fly, AlongGridLinesAndThroughCornersInAllEightDirections) {
  const Surface surface(test::terrain(test::grid_of(41, 41, 2.0, 2.0), [](double, double) { return 0.0; }));
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      for (const bool grounded : {false, true}) {
        const Vec3 start(41.0, 41.0, 0.0), v(4.0 * dx, 4.0 * dy, 0.5 * kGravity * 3.0);  // 3 s, 12 m: lands on a corner
        const Flight f(surface, start, v, grounded);
        ASSERT_EQ(f.end, FlightEnd::Landed) << dx << ' ' << dy;
        EXPECT_NEAR(f.motion.time, 3.0, 1e-14) << dx << ' ' << dy;
        EXPECT_LT((f.motion.position - start - Vec3(12.0 * dx, 12.0 * dy, 0)).norm(), 1e-13);
      }
}

TEST(Fly,
     ABlockOnAnEdgeThatRisesDoesNotLandAtOnce) {  // released above a cell centre, it rebounds across p = 0 or q = 0
  for (const double dip : {-0.75, 0.75})
    for (const bool along_x : {true, false}) {
      const Surface surface(test::terrain(test::grid_of(60, 60, 2.0, 2.0),
                                          [&](double x, double y) { return 100.0 + dip * (along_x ? x : y); }));
      const Vec3 down = along_x ? Vec3(1, 0, dip) : Vec3(0, 1, dip);  // times -sign(dip): down the slope
      const double s = dip < 0 ? 1.0 : -1.0;
      const Vec3 v = s * 4.0 * Vec3(down.x(), down.y(), 0.0) + Vec3(0, 0, 1.5);
      const Flight f(surface, {61.0, 61.0, *surface.height(61.0, 61.0)}, v, true);
      EXPECT_NEAR(f.motion.time, 2.0 * (1.5 + 0.75 * 4.0) / kGravity, 1e-13);
    }
}

TEST(Fly, VerticalDropOnARoughSurface) {
  Numbers numbers(3);
  const Surface surface(
      test::terrain(test::grid_of(30, 30, 2.0, 5.0), [&](double, double) { return numbers.uniform(0, 20); }),
      SurfaceKind::Bilinear);
  for (int i = 0; i < 1000; ++i) {
    const double x = numbers.uniform(1.0, 59.0), y = numbers.uniform(2.5, 147.5),
                 z = test::height_between_centres(surface.heights(), x, y);
    const Flight f(surface, {x, y, z + 7.0}, {0, 0, 0});
    ASSERT_EQ(f.end, FlightEnd::Landed);
    ASSERT_NEAR(f.motion.time, std::sqrt(14.0 / kGravity), 1e-13);
    ASSERT_NEAR(f.motion.position.z(), z, 1e-12);
    ASSERT_EQ(f.path.spans.size(), 1U);
    ASSERT_NEAR(f.path.length, 7.0, 1e-12);
  }
}

TEST(Fly, IntoAndOverAWallOf500MetresOfOneCell) {
  for (const double cell : {0.5, 2.0}) {
    const int n = 200;
    const double foot = 100.0 * cell + 0.5 * cell;  // the wall rises from here to the next centre
    const Surface surface(test::terrain(test::grid_of(n, 5, cell, cell),
                                        [&](double x, double) { return x > foot + 0.1 * cell ? 500.0 : 0.0; }));
    const double y = 2.3 * cell, start = foot - 10.0 * cell, v = 10.0;
    // Against the wall: while over it, z = h - g t^2/2 = 500 (x - foot)/cell.
    const Flight into(surface, {start, y, 300.0}, {v, 0, 0});
    ASSERT_EQ(into.end, FlightEnd::Landed);
    const double b = 500.0 * v / cell, c = 300.0 + 500.0 * 10.0,
                 t = (-b + std::sqrt(b * b + 2 * kGravity * c)) / kGravity;
    EXPECT_NEAR(into.motion.time, t, 1e-12);
    EXPECT_NEAR(into.motion.position.x(), start + v * t, 1e-11);
    // Off its top: over the edge after 0.05 cells, then free fall to the floor.
    const Flight off(surface, {foot + 1.05 * cell, y, 500.0}, {-3.0 * cell, 0, 3.0}, true);
    ASSERT_EQ(off.end, FlightEnd::Landed);
    EXPECT_NEAR(off.motion.time, (3.0 + std::sqrt(9.0 + 1000.0 * kGravity)) / kGravity, 1e-12);
    EXPECT_EQ(off.motion.position.z(), 0.0);
  }
}

TEST(Fly, LeavesAtTheBorderOfTheCentresAndAtMissingData) {
  Raster<float> heights = test::terrain(test::grid_of(20, 20, 2.0, 2.0), [](double, double) { return 0.0; });
  heights.at(15, 10) = std::numeric_limits<float>::quiet_NaN();  // takes patches 14 and 15: from x = 29
  const Surface surface(heights);
  const Flight missing(surface, {20.0, 20.5, 50.0}, {10, 0, 0});
  EXPECT_EQ(missing.end, FlightEnd::Left);
  EXPECT_NEAR(missing.motion.position.x(), 29.0, 1e-12);
  EXPECT_NEAR(missing.motion.position.z(), 50.0 - 0.5 * kGravity * 0.81, 1e-12);
  for (const auto& [v, edge] : {std::pair{Vec3(10, 0, 0), 39.0}, {Vec3(-10, 0, 0), 1.0}}) {
    const Flight f(surface, {20.0, 5.5, 50.0}, v);
    EXPECT_EQ(f.end, FlightEnd::Left);
    EXPECT_NEAR(f.motion.position.x(), edge, 1e-12);
  }
  EXPECT_EQ(Flight(surface, {0.5, 20.0, 5.0}, {10, 0, 0}).end, FlightEnd::Left);  // starts outside
  EXPECT_EQ(Flight(surface, {20.0, 20.0, 5.0}, {std::nan(""), 0, 0}).end, FlightEnd::Left);
  EXPECT_EQ(Flight(surface, {20.0, 20.0, std::nan("")}, {1, 0, 0}).end, FlightEnd::Left);
}

}  // namespace
}  // namespace talus
