#include <gtest/gtest.h>

#include <cmath>

#include "support/scenarios.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

double plan_distance(const PathPoint& a, const PathPoint& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

TEST(PointsOf, EveryVertexAndTheParabolaBetween) {  // 4 s at (5, 0, 10): 20 m in plan
  Path path;
  path.vertices = {{{2.0, {10, 20, 100}, {5, 0, 10}, Vec3::Zero()}, Event::Release},
                   {{6.0, {30, 20, 100 + 40 - 0.5 * 9.81 * 16}, {0, 0, 0}, Vec3::Zero()}, Event::End}};
  for (const double spacing : {0.5, 3.0, 7.0, 20.0, 1000.0}) {
    const auto points = points_of(path, spacing);
    ASSERT_EQ(points.size(), 1U + static_cast<std::size_t>(std::max(1.0, std::ceil(20.0 / spacing)))) << spacing;
    EXPECT_EQ(points.front().x, 10.0);
    EXPECT_EQ(points.front().time, 2.0);
    EXPECT_EQ(points.back().x, 30.0);
    EXPECT_EQ(points.back().time, 6.0);
    for (const PathPoint& p : points) {
      const double t = p.time - 2.0;
      EXPECT_NEAR(p.x, 10.0 + 5.0 * t, 1e-12);
      EXPECT_EQ(p.y, 20.0);
      EXPECT_NEAR(p.z, 100.0 + 10.0 * t - 0.5 * 9.81 * t * t, 1e-11);
    }
  }
}

TEST(PointsOf, SlidesAreStraight) {
  Path path;
  path.vertices = {{{0.0, {10, 20, 100}, {5, 0, 0}, Vec3::Zero()}, Event::Slide},
                   {{1.0, {14, 20, 99}, {3, 0, 0}, Vec3::Zero()}, Event::End}};
  const auto points = points_of(path, 1.0);
  for (const PathPoint& p : points) EXPECT_NEAR(p.z, 100.0 - 0.25 * (p.x - 10.0), 1e-12);
}

TEST(PointsOf, WholePathsAreDenseInOrderAndHitTheirVertices) {
  const Scenario s = test::rough_slope(1, 30);
  Path path;
  for (std::uint32_t block = 0; block < 30; ++block) {
    trace(s.world(), make_release(s, 0, block), path);
    const auto points = points_of(path, 2.0);
    std::size_t vertex = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PathPoint& before = points[i == 0 ? 0 : i - 1];
      ASSERT_GE(points[i].time, before.time);
      ASSERT_LE(plan_distance(before, points[i]), 2.0 * (1.0 + 1e-9));
      while (vertex < path.vertices.size() && points[i].x == path.vertices[vertex].motion.position.x() &&
             points[i].z == path.vertices[vertex].motion.position.z())
        ++vertex;
    }
    EXPECT_EQ(vertex, path.vertices.size()) << block;
  }
}

TEST(PointsOf, AFallStraightDownIsTwoPoints) {
  Path path;
  path.vertices = {{{0.0, {10, 20, 100}, {0, 0, 0}, Vec3::Zero()}, Event::Release},
                   {{1.0, {10, 20, 95.095}, {0, 0, 0}, Vec3::Zero()}, Event::End}};
  EXPECT_EQ(points_of(path, 1.0).size(), 2U);
}

}  // namespace
}  // namespace talus
