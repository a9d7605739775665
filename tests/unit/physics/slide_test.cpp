#include "talus/physics/slide.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace talus {
namespace {

using test::kTan30;
using test::Numbers;
using Vec2 = Eigen::Vector2d;

Cover cover_of(double tan_phi) {
  return {{Ground{.tan_phi = tan_phi}}, {}};
}

/// A block put on the surface with a velocity in plan, and its slide.
struct Slide {
  Motion motion;
  PatchIndex at;
  Path path;
  SlideEnd end;

  Slide(const Surface& surface, double tan_phi, const Vec2& place, const Vec2& v, double diameter) {
    at = surface.patch_at(place.x(), place.y());
    Patch patch;
    EXPECT_TRUE(surface.read(at, patch));
    const Vec2 slope = surface.gradient(patch, surface.u_of(place.x()) - at.column, surface.v_of(place.y()) - at.row);
    motion.position = {place.x(), place.y(), *surface.height(place.x(), place.y())};
    motion.velocity = {v.x(), v.y(), v.dot(slope)};
    motion.spin = {1, 2, 3};
    const Cover cover = cover_of(tan_phi);
    end = slide(surface, cover, motion, at, {diameter}, 0.5, path);
  }
  double speed() const { return motion.velocity.norm(); }
};

Surface plane(double east, double north, double cell = 2.0) {
  return Surface(test::terrain(test::grid_of(200, 200, cell, cell),
                               [&](double x, double y) { return 2000.0 + east * x + north * y; }));
}

/// Up a slope steeper than phi, to rest, and down again: friction turns with the motion. By hand: g (sin b + tan(phi)
/// cos b) on the way up, g (sin b - tan(phi) cos b) on the way down, one diameter in all.
TEST(SlideOnAPlane, TurnsOnASteepSlope) {
  const double b = radians(40.0), v0 = 0.64, diameter = 0.4;
  const double up = kGravity * (std::sin(b) + kTan30 * std::cos(b)),
               down = kGravity * (std::sin(b) - kTan30 * std::cos(b));
  const Slide s(plane(std::tan(b), 0.0), kTan30, {200.3, 150.7}, {v0 * std::cos(b), 0.0}, diameter);
  ASSERT_EQ(s.end, SlideEnd::NextAsperity);
  const double back = std::sqrt(2.0 * down * (diameter - v0 * v0 / (2.0 * up)));
  EXPECT_LT(s.motion.velocity.x(), 0.0);
  EXPECT_NEAR(s.speed(), back, 1e-4 * back);
  EXPECT_NEAR(s.motion.time, v0 / up + back / down, 1e-4);
}

TEST(SlideOnAPlane, SpeedAfterOneDiameterDownTheSlope) {  // v^2 = v0^2 + 2 g (sin b - tan(phi) cos b) D
  for (const double tan_b : {0.75, 1.0, 3.0})
    for (const double v0 : {0.0, 0.3, 5.0, 30.0})
      for (const double diameter : {0.4, 1.2, 6.0}) {
        const double b = std::atan(tan_b), a = kGravity * (std::sin(b) - kTan30 * std::cos(b));
        const Slide s(plane(-tan_b, 0.0), kTan30, {200.3, 150.7}, {v0 * std::cos(b), 0.0}, diameter);
        ASSERT_EQ(s.end, SlideEnd::NextAsperity);
        EXPECT_NEAR(s.speed(), std::sqrt(v0 * v0 + 2 * a * diameter), 1e-6 * s.speed());
        EXPECT_NEAR(s.path.length, diameter, 2e-6 * diameter);  // rule (c): exactly one diameter
        EXPECT_NEAR(s.motion.time, (s.speed() - v0) / a, 1e-6 * s.motion.time);
        EXPECT_NEAR(s.motion.position.y(), 150.7, 1e-12);
        EXPECT_NEAR(s.motion.position.z(), 2000.0 - tan_b * s.motion.position.x(), 1e-9);
        EXPECT_EQ(s.motion.spin, Vec3(1, 2, 3));  // spin does not change
      }
}

TEST(SlideOnAPlane, StoppingDistance) {  // v^2 / (2 g (tan(phi) cos b - sin b)), less what is left at the stop speed
  for (const double tan_b : {0.0, 0.25, 0.5})
    for (const double v0 : {1.0, 6.0, 15.0}) {
      const double b = std::atan(tan_b), brake = kGravity * (kTan30 * std::cos(b) - std::sin(b));
      const Slide s(plane(-tan_b, 0.0), kTan30, {100.3, 150.7}, {v0 * std::cos(b), 0.0}, 1000.0);
      ASSERT_EQ(s.end, SlideEnd::Stopped);
      EXPECT_NEAR(s.path.length, (v0 * v0 - 0.25) / (2 * brake), 1e-6 * (1 + s.path.length));
      EXPECT_LE(s.speed(), 0.5);
      EXPECT_NEAR(s.motion.time, (v0 - 0.5) / brake, 1e-6);
    }
}

TEST(SlideOnAPlane, UphillItStopsOrTurnsRoundWhereTheSlopeIsSteeper) {
  const double b = std::atan(1.0), up = kGravity * (std::sin(b) + kTan30 * std::cos(b)),
               down = kGravity * (std::sin(b) - kTan30 * std::cos(b));
  const Slide s(plane(-1.0, 0.0), kTan30, {200.3, 150.7}, {-5.0 * std::cos(b), 0.0}, 2.0);
  const double climb = 25.0 / (2 * up);  // 1.616 m, then 2 - 1.616 m down again
  ASSERT_EQ(s.end, SlideEnd::NextAsperity);
  EXPECT_NEAR(s.path.length, 2.0, 0.06);  // the piece that turns round counts its chord only
  EXPECT_NEAR(s.speed(), std::sqrt(2 * down * (2.0 - climb)), 0.02);
  EXPECT_GT(s.motion.velocity.x(), 0.0);
  const Slide held(plane(-0.5, 0.0), kTan30, {200.3, 150.7}, {-3.0, 0.0}, 100.0);
  EXPECT_EQ(held.end, SlideEnd::Stopped);
}

TEST(SlideOnAPlane, HeldWhereFrictionExceedsGravity) {
  for (const double speed : {0.0, 0.49}) {
    const Slide s(plane(-0.5, 0.0), kTan30, {200.3, 150.7}, {0.0, speed}, 1.0);
    EXPECT_EQ(s.end, SlideEnd::Stopped);
    EXPECT_EQ(s.motion.time, 0.0);
    EXPECT_TRUE(s.path.spans.empty());
  }
  EXPECT_EQ(Slide(plane(-0.625, 0.0), kTan30, {200.3, 150.7}, {0.0, 0.0}, 1.0).end,
            SlideEnd::NextAsperity);  // 32 degrees
}

TEST(SlideOnAPlane, AnyDirectionOfDipIsTheSame) {
  const double v0 = 3.0, reference = Slide(plane(-0.75, 0.0), kTan30, {200.3, 150.7}, {v0 * 0.8, 0.0}, 5.0).speed();
  for (const auto& [e, n] : {std::pair{0.75, 0.0}, {0.0, 0.75}, {0.0, -0.75}}) {
    const Vec2 dip = -Vec2(e, n).normalized();
    const Slide s(plane(e, n), kTan30, {200.3, 150.7}, v0 * 0.8 * dip, 5.0);
    EXPECT_NEAR(s.speed(), reference, 1e-9);
  }
}

/// State of a block in the tilted plane: along the dip and along the strike, by RK4 with a tiny step, until `distance`.
struct Tilted {
  double along, across, v_along, v_across;
};
Tilted rk4_on_plane(double b, double v_along, double v_across, double distance) {
  using State = Eigen::Array4d;  // place, place, speed, speed
  const auto rate = [&](const State& s) {
    const double v = std::hypot(s[2], s[3]), f = kTan30 * kGravity * std::cos(b) / v;
    return State(s[2], s[3], kGravity * std::sin(b) - f * s[2], -f * s[3]);
  };
  State s(0, 0, v_along, v_across);
  const double h = 1e-4;
  for (double length = 0.0; length < distance;) {
    const State a = rate(s), c = rate(s + 0.5 * h * a), d = rate(s + 0.5 * h * c), e = rate(s + h * d);
    length += h * std::hypot(s[2], s[3]);
    s += h / 6.0 * (a + 2 * c + 2 * d + e);
  }
  return {s[0], s[1], s[2], s[3]};
}

TEST(SlideOnAPlane, BendsDownASideSlopeAsRungeKuttaSays) {
  for (const double tan_b : {0.25, 0.75, 1.0}) {
    const double b = std::atan(tan_b), diameter = 1.0;
    const Slide s(plane(-tan_b, 0.0), kTan30, {200.3, 150.7}, {1.0 * std::cos(b), 4.0}, diameter);
    ASSERT_EQ(s.end, SlideEnd::NextAsperity);
    const Tilted t = rk4_on_plane(b, 1.0, 4.0, diameter);
    const double pieces = static_cast<double>(s.path.spans.size());
    EXPECT_NEAR((s.motion.position.x() - 200.3) / std::cos(b), t.along, pieces * diameter * 1e-3);  // the stated bound
    EXPECT_NEAR(s.motion.position.y() - 150.7, t.across, pieces * diameter * 1e-3);
    EXPECT_NEAR(s.motion.velocity.y(), t.v_across, 0.01 * 4.0);
    EXPECT_NEAR(s.motion.velocity.x() / std::cos(b), t.v_along, 0.01 * 4.0);
    EXPECT_LT(pieces, 40.0);
  }
}

TEST(SlidingAcceleration, IsNewtonsLawOnTheSurface) {
  // In space: A = g_tangential - tan(phi) g cos(b) V/|V| + n (v.H.v)/w, because A.n w = d2z/dt2 - slope.a = v.H.v on z
  // = f(x, y).
  Numbers numbers(1);
  for (int i = 0; i < 10'000; ++i) {
    const Vec2 slope(numbers.uniform(-3, 3), numbers.uniform(-3, 3)), v(numbers.uniform(-9, 9), numbers.uniform(-9, 9));
    const double twist = numbers.uniform(-0.1, 0.1), tan_phi = numbers.uniform(0, 1);
    const Vec3 n = normal_of(slope), speed(v.x(), v.y(), slope.dot(v)), gravity(0, 0, -kGravity);
    const Vec3 a = gravity - gravity.dot(n) * n - tan_phi * kGravity * n.z() * speed.normalized() +
                   2 * twist * v.x() * v.y() * n.z() * n;
    ASSERT_LT((sliding_acceleration(slope, twist, v, tan_phi) - a.head<2>()).norm(), 1e-12 * (1 + a.norm()));
  }
}

TEST(SlidingAcceleration, AtRestDownTheSlopeOrHeld) {
  EXPECT_EQ(sliding_acceleration({0.3, 0.4}, 0.0, Vec2::Zero(), 0.5).norm(), 0.0);  // tan b = 0.5 = tan(phi)
  const Vec2 a = sliding_acceleration({-0.6, -0.8}, 0.0, Vec2::Zero(), 0.5);        // 45 degrees: g (1 - 0.5)/2 in plan
  EXPECT_LT((a - 0.25 * kGravity * Vec2(0.6, 0.8)).norm(), 1e-14);
}

}  // namespace
}  // namespace talus
