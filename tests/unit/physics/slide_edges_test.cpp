#include <gtest/gtest.h>

#include "support/scenes.hpp"
#include "talus/physics/slide.hpp"

namespace talus {
namespace {

using test::kTan30;
using test::Numbers;
using Vec2 = Eigen::Vector2d;

struct Result {
  Motion motion;
  PatchIndex at;
  Path path;
  SlideEnd end;
};

Result slide_from(const Surface& surface, double tan_phi, const Vec2& place, const Vec2& v, double diameter) {
  Result o;
  o.at = surface.patch_at(place.x(), place.y());
  Patch patch;
  EXPECT_TRUE(surface.read(o.at, patch));
  const double p = surface.u_of(place.x()) - o.at.column, q = surface.v_of(place.y()) - o.at.row;
  const Vec2 slope = surface.gradient(surface.facet(patch, p, q, {v.x(), v.y(), 0.0}), p, q);
  o.motion.position = {place.x(), place.y(), *surface.height(place.x(), place.y())};
  o.motion.velocity = {v.x(), v.y(), v.dot(slope)};
  const Cover cover{{Ground{.tan_phi = tan_phi}}, {}};
  o.end = slide(surface, cover, o.motion, o.at, {diameter}, 0.5, o.path);
  return o;
}

/// z(x) with a kink at the centre of column 20 (x = 41): slope `before` west of it and `after` east of it.
Surface kinked(double before, double after) {
  return Surface(test::terrain(test::grid_of(60, 9, 2.0, 2.0),
                               [&](double x, double) { return 300.0 + (x < 41.0 ? before : after) * (x - 41.0); }));
}

double pull(double tan_b, double tan_phi) {  // g (sin b - tan(phi) cos b)
  return kGravity * (tan_b - tan_phi) / std::hypot(1.0, tan_b);
}

TEST(SlideAcrossAnEdge, TakesOffWhereTheGroundFallsAway) {
  for (const double after : {-0.76, -1.5, -60.0}) {
    const auto o = slide_from(kinked(-0.75, after), kTan30, {38.6, 9.3}, {3.2, 0.0}, 10.0);
    ASSERT_EQ(o.end, SlideEnd::Takeoff);
    EXPECT_NEAR(o.motion.position.x(), 41.0, 1e-9);
    EXPECT_EQ(o.at, (PatchIndex{20, 4}));
    const double speed = std::sqrt(16.0 + 2 * pull(0.75, kTan30) * 3.0);  // 2.4 m in plan are 3 m of slope
    EXPECT_NEAR(o.motion.velocity.norm(), speed, 1e-9);
    EXPECT_NEAR(o.motion.velocity.z(), -0.6 * speed, 1e-9);  // along the slope it comes from
  }
}

TEST(SlideAcrossAnEdge, KeepsItsSpeedWhereTheGroundTurnsUp) {
  for (const double after : {-0.6875, 0.0, 0.5}) {
    const auto o = slide_from(kinked(-0.75, after), kTan30, {38.6, 9.3}, {8.0, 0.0}, 5.0);
    ASSERT_EQ(o.end, SlideEnd::NextAsperity) << after;
    const double at_edge2 = 100.0 + 2 * pull(0.75, kTan30) * 3.0;
    EXPECT_NEAR(o.motion.velocity.norm(), std::sqrt(at_edge2 + 2 * pull(-after, kTan30) * 2.0), 1e-5);
    EXPECT_NEAR((o.motion.position.x() - 41.0) * std::hypot(1.0, after), 2.0, 1e-4);
    EXPECT_NEAR(o.motion.velocity.z(), after * o.motion.velocity.x(), 1e-9);
  }
}

TEST(SlideAcrossAnEdge, OnAPlaneEdgesDoNothing) {
  const auto o = slide_from(kinked(-0.75, -0.75), kTan30, {38.6, 9.3}, {0.0, 4.0}, 12.0);
  EXPECT_EQ(o.end, SlideEnd::NextAsperity);
  const Surface large(
      test::terrain(test::grid_of(4, 4, 128.0, 128.0), [](double x, double) { return 300.0 - 0.75 * x; }));
  const auto one = slide_from(large, kTan30, {168.6, 150.3}, {0.0, 4.0}, 12.0);
  EXPECT_LT((Vec2(o.motion.position.x() - 38.6, o.motion.position.y() - 9.3) -
             Vec2(one.motion.position.x() - 168.6, one.motion.position.y() - 150.3))
                .norm(),
            0.02);
}

TEST(SlideOnATwist, TakesOffWhereTheSurfaceCurvesAwayFasterThanTheParabola) {
  // z = 300 + k x y about (21, 21): along the direction (1, -1) it curves down by 2 k vx vy = -k v^2: beyond g it
  // flies.
  const double k = 0.125;
  const Surface surface(test::terrain(test::grid_of(3, 3, 16.0, 16.0),
                                      [&](double x, double y) { return 300.0 + k * (x - 16.0) * (y - 16.0); }),
                        SurfaceKind::Bilinear);
  const double limit = std::sqrt(kGravity / (2 * k));  // of |vx| = |vy|
  EXPECT_EQ(slide_from(surface, 0.0, {16.0, 16.0}, {1.01 * limit, -1.01 * limit}, 0.2).end, SlideEnd::Takeoff);
  EXPECT_EQ(slide_from(surface, 0.0, {16.0, 16.0}, {0.9 * limit, -0.9 * limit}, 0.2).end, SlideEnd::NextAsperity);
  EXPECT_EQ(slide_from(surface, 0.0, {16.0, 16.0}, {1.5 * limit, 1.5 * limit}, 0.2).end,
            SlideEnd::NextAsperity);  // curves up
}

class SlideWithoutFriction : public testing::TestWithParam<SurfaceKind> {};

TEST_P(SlideWithoutFriction, KeepsItsEnergyOnAnySurface) {  // v^2/2 + g z, in patches and across concave edges
  Numbers numbers(2);
  const Surface surface(
      test::terrain(test::grid_of(40, 40, 4.0, 4.0), [&](double, double) { return numbers.uniform(0, 4); }),
      GetParam());
  test::Moments drift;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 place(numbers.uniform(60, 100), numbers.uniform(60, 100)),
        v(numbers.uniform(-4, 4), numbers.uniform(-4, 4));
    const auto o = slide_from(surface, 0.0, place, v, 1.0);
    if (o.path.vertices.empty()) continue;  // flies at once
    const Motion& start = o.path.vertices.front().motion;
    const auto energy = [](const Motion& m) { return 0.5 * m.velocity.squaredNorm() + kGravity * m.position.z(); };
    drift.add((energy(o.motion) - energy(start)) / (0.5 * start.velocity.squaredNorm() + kGravity));
    ASSERT_LT(std::abs(energy(o.motion) - energy(start)), 0.02 * (0.5 * start.velocity.squaredNorm() + kGravity)) << i;
  }
  EXPECT_NEAR(drift.mean(), 0.0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, SlideWithoutFriction, testing::Values(SurfaceKind::Bilinear, SurfaceKind::Creased),
                         [](const auto& test) { return std::string(name_of(test.param)); });

/// A V gully at 45 degrees to the grid, its thalweg through the cell centres: floor 35.3 degrees, walls 46.7. The
/// heights are short binary fractions.
Surface diagonal_gully(SurfaceKind kind) {
  return Surface(test::terrain(test::grid_of(60, 60, 2.0, 2.0),
                               [](double x, double y) { return 500.0 - 0.5 * (x + y) + 0.75 * std::abs(y - x); }),
                 kind);
}

TEST(SlideAcrossACrease, CrossesTheThalwegAndKeepsItsEnergy) {
  const Surface surface = diagonal_gully(SurfaceKind::Creased);
  for (const double turned : {0.2, 0.5, 0.9}) {  // of the velocity from the thalweg
    const Vec2 v(6.0 * std::cos(kPi / 4 + turned), 6.0 * std::sin(kPi / 4 + turned));
    const auto o = slide_from(surface, 0.0, {40.7, 40.2}, v, 3.0);
    ASSERT_EQ(o.end, SlideEnd::NextAsperity);
    EXPECT_GT(o.motion.position.y() - o.motion.position.x(), 0.01);  // on the other wall
    const Motion& start = o.path.vertices.front().motion;
    EXPECT_NEAR(o.motion.velocity.squaredNorm() + 2 * kGravity * o.motion.position.z(),
                start.velocity.squaredNorm() + 2 * kGravity * start.position.z(), 1e-6 * start.velocity.squaredNorm());
    EXPECT_NEAR(o.motion.position.z(), *surface.height(o.motion.position.x(), o.motion.position.y()), 1e-5);
  }
}

TEST(SlideAlongACrease, GoesDownTheThalwegAsOnAPlaneOfItsSlope) {
  const Surface surface = diagonal_gully(SurfaceKind::Creased);
  const double beta = std::atan(std::sqrt(0.5)), way = 12.0;
  const auto o = slide_from(surface, 0.0, {41.0, 41.0}, {1.0, 1.0}, way);
  ASSERT_EQ(o.end, SlideEnd::NextAsperity);
  const double start2 = o.path.vertices.front().motion.velocity.squaredNorm();
  EXPECT_NEAR(o.motion.velocity.norm(), std::sqrt(start2 + 2 * kGravity * std::sin(beta) * way), 1e-3);
  EXPECT_NEAR(o.motion.position.x(), 41.0 + way * std::cos(beta) * std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(o.motion.position.y(), o.motion.position.x(), 1e-6);
  EXPECT_EQ(slide_from(diagonal_gully(SurfaceKind::Bilinear), 0.3, {41.0, 41.0}, {0.1, 0.1}, way).end,
            SlideEnd::Trapped);
  EXPECT_EQ(slide_from(surface, 0.3, {41.0, 41.0}, {0.1, 0.1}, way).end, SlideEnd::NextAsperity);
}

TEST(SlidePath, PiecesFollowEachOtherOnTheSurface) {
  Numbers numbers(3);
  const Surface surface(test::terrain(test::grid_of(40, 40, 4.0, 4.0),
                                      [&](double x, double) { return -0.8 * x + numbers.uniform(0, 2); }));
  for (int i = 0; i < 500; ++i) {
    const auto o = slide_from(surface, kTan30, {numbers.uniform(60, 100), numbers.uniform(60, 100)},
                              {numbers.uniform(0, 4), numbers.uniform(-3, 3)}, 2.0);
    ASSERT_EQ(o.path.vertices.size(), o.path.spans.size());
    for (std::size_t k = 0; k < o.path.spans.size(); ++k) {
      const Motion& from = o.path.vertices[k].motion;
      const Motion& to = k + 1 < o.path.spans.size() ? o.path.vertices[k + 1].motion : o.motion;
      const Span& s = o.path.spans[k];
      ASSERT_NEAR(from.position.z(),
                  test::height_between_centres(surface.heights(), from.position.x(), from.position.y()), 1e-8);
      ASSERT_GE(to.time, from.time);
      ASSERT_NEAR(surface.x_of(1.0 * s.patch.column + s.p_from), from.position.x(), 1e-4);
      ASSERT_NEAR(surface.y_of(1.0 * s.patch.row + s.q_to), to.position.y(), 1e-4);
      ASSERT_NEAR(s.rise_from, from.velocity.norm(), 1e-4);
      ASSERT_EQ(s.height_from + s.height_to, 0.0F);
    }
    ASSERT_LE(o.path.length, 2.0 * 1.01);
  }
}

TEST(SlideInAGully, IsBounded) {  // between walls steeper than phi: from wall to wall, without end but for the bounds
  const Surface surface(test::terrain(test::grid_of(60, 61, 2.0, 2.0),
                                      [](double x, double y) { return 300.0 - 0.125 * x + 2.0 * std::abs(y - 61.0); }));
  for (const double start : {60.0, 61.0, 61.3, 64.0})
    for (const Vec2& v : {Vec2(0, 0), Vec2(3, 0), Vec2(1, 4), Vec2(-2, 0.01)}) {
      const auto o = slide_from(surface, kTan30, {50.3, start}, v, 1.0);
      EXPECT_LE(o.path.spans.size(), 1000U);
      EXPECT_TRUE(o.motion.position.allFinite() && o.motion.velocity.allFinite());
      EXPECT_LE(o.path.length, 1.05);
      EXPECT_LE(o.motion.velocity.norm(), std::hypot(v.norm() * std::sqrt(5.0), std::sqrt(2 * kGravity * 1.0)) + 0.1);
    }
}

// The bottom of a V is a straight line: gravity along it, tan(phi) g cos(beta) of the walls (gradient (-a, +-2))
// against the motion.
TEST(SlideInAGully, RunsAlongTheBottomInClosedForm) {
  for (const double fall : {0.0, 1.0}) {
    const Surface surface(test::terrain(test::grid_of(90, 61, 2.0, 2.0), [&](double x, double y) {
      return 300.0 - fall * x + 2.0 * std::abs(y - 61.0);
    }));
    const double a = kGravity * (fall / std::hypot(1.0, fall) - kTan30 / std::sqrt(5.0 + fall * fall));
    for (const double v0 : {2.0, 5.0}) {
      const auto o = slide_from(surface, kTan30, {50.3, 61.0}, {v0 / std::hypot(1.0, fall), 0.0}, 9.0);
      const double way = std::min(9.0, a < 0.0 ? v0 * v0 / (-2 * a) : 9.0), v2 = v0 * v0 + 2 * a * way;
      EXPECT_NEAR((o.motion.position.x() - 50.3) * std::hypot(1.0, fall), way, 0.01) << fall << ' ' << v0;
      EXPECT_NEAR(o.motion.velocity.norm(), std::sqrt(std::max(0.0, v2)), 0.01);
      EXPECT_NEAR(o.motion.position.y(), 61.0, 1e-6);
      EXPECT_EQ(o.end, v2 > 1e-9 ? SlideEnd::NextAsperity : SlideEnd::Trapped);
    }
  }
}

/// A pyramid upside down: all walls have one slope, so friction is f = tan(phi) g cos(beta) everywhere. A block that
/// has come down to the bottom, a way L, has v^2 = v0^2 + 2 g h - 2 f L. At that speed it meets the next asperity,
/// after the time of the rest of its diameter, (D - L)/v seconds.
TEST(SlideInAPit, TheBlockKeepsItsSpeedForTheTimeOfTheRestOfOneDiameter) {
  const double wall = 1.25, diameter = 1.0, friction = kTan30 * kGravity / std::sqrt(1.0 + 2.0 * wall * wall);
  const Surface pit(test::terrain(test::grid_of(61, 61, 2.0, 2.0), [&](double x, double y) {
    return wall * (std::abs(x - 61.0) + std::abs(y - 61.0));
  }));
  Numbers numbers(4);
  int compared = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec2 place(numbers.uniform(60.5, 61.5), numbers.uniform(60.5, 61.5)),
        v(numbers.uniform(-6, 6), numbers.uniform(-6, 6));
    const auto o = slide_from(pit, kTan30, place, v, diameter);
    if (o.end == SlideEnd::Takeoff || (o.motion.position - Vec3(61.0, 61.0, 0.0)).norm() > 0.01) continue;
    const Motion &start = o.path.vertices.front().motion, &last = o.path.vertices.back().motion;
    const double left = diameter - o.path.length;
    const double squared =
        start.velocity.squaredNorm() + 2.0 * kGravity * start.position.z() - 2.0 * friction * o.path.length;
    if (left < 0.02 || squared < 1.0) continue;
    const double speed = std::sqrt(squared);
    ASSERT_EQ(o.end, SlideEnd::NextAsperity) << i;
    ASSERT_NEAR(o.motion.velocity.norm(), speed, 0.02) << i;  // L is the sum of chords
    const double down = 2.0 * (o.motion.position - last.position).norm() / (last.velocity.norm() + speed);
    ASSERT_NEAR(o.motion.time - last.time, down + left / speed, 0.05 * (down + left / speed)) << i;
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(SlideOffTheTerrain, IsLeft) {
  const Surface edge = kinked(-0.75, -0.75);
  EXPECT_EQ(slide_from(edge, kTan30, {117.5, 9.3}, {8.0, 0.0}, 50.0).end, SlideEnd::Left);
  Raster<float> heights = kinked(-0.75, -0.75).heights();
  heights.at(22, 4) = std::numeric_limits<float>::quiet_NaN();
  const auto o = slide_from(Surface(heights), kTan30, {38.6, 9.3}, {8.0, 0.0}, 50.0);
  EXPECT_EQ(o.end, SlideEnd::Left);
  EXPECT_NEAR(o.motion.position.x(), 43.0, 1e-9);
}

TEST(SlideNaN, Ends) {
  const Surface surface = kinked(-0.75, -0.75);
  Motion motion;
  motion.position = {38.6, 9.3, *surface.height(38.6, 9.3)};
  motion.velocity = {std::nan(""), 1.0, 0.0};
  PatchIndex at = surface.patch_at(38.6, 9.3);
  Path path;
  const Cover cover{{Ground{}}, {}};
  slide(surface, cover, motion, at, {1.0}, 0.5, path);
  EXPECT_LE(path.spans.size(), 1000U);
}

}  // namespace
}  // namespace talus
