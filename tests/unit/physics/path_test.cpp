#include "talus/physics/path.hpp"

#include <gtest/gtest.h>

#include <tuple>
#include <utility>

#include "support/scenes.hpp"
#include "talus/physics/slide.hpp"

namespace talus {
namespace {

using test::Numbers;

/// A piece of sliding with these velocities at its start and constant acceleration, in closed form.
std::pair<Vertex, Vertex> piece(const Vec3& velocity, const Vec3& acceleration, double duration) {
  Vertex from{{7.0, {100.0, 50.0, 30.0}, velocity, {1.0, 2.0, 3.0}}, Event::Slide}, to = from;
  to.motion.time += duration;
  to.motion.position += duration * velocity + 0.5 * duration * duration * acceleration;
  to.motion.velocity.setZero();  // after an impact: says nothing of the end of the piece
  return {from, to};
}

/// v^2 = v0^2 + 2 a s and t = (v - v0)/a at the way s, for pieces that get faster, get slower, come to rest, or
/// neither.
TEST(MotionBetween, OnAStraightSlideAsInClosedForm) {
  const Vec3 heading = Vec3(2.0, -1.0, -2.0) / 3.0;
  for (const auto& [v0, a, duration] : {std::tuple{0.0, 2.932, 1.4},
                                        {0.3, 5.0, 0.01},
                                        {6.0, -2.0, 2.5},
                                        {4.0, -2.0, 2.0},
                                        {3.0, 0.0, 0.7},
                                        {1e-3, 0.2, 0.5}}) {
    const auto [from, to] = piece(v0 * heading, a * heading, duration);
    const double length = v0 * duration + 0.5 * a * duration * duration;
    for (const double share : {0.0, 0.007, 0.25, 0.5, 0.9, 1.0}) {
      const Motion m = motion_between(from, to, share);
      const double speed = std::sqrt(std::max(0.0, v0 * v0 + 2.0 * a * share * length));
      const double time = speed + v0 > 0.0 ? 2.0 * share * length / (v0 + speed) : 0.0;
      EXPECT_NEAR(m.velocity.norm(), speed, 1e-6 * (v0 + std::abs(a) * duration)) << v0 << ' ' << a << ' ' << share;
      EXPECT_LT((m.velocity - speed * heading).norm(), 1e-6 * (v0 + std::abs(a) * duration));
      EXPECT_NEAR(m.time, 7.0 + time, 1e-6 * duration);
      EXPECT_LT((m.position - from.motion.position - share * length * heading).norm(), 1e-12);
      EXPECT_EQ(m.spin, from.motion.spin);
    }
  }
}

/// A piece that turns: at its ends it has the velocities of its parabola, between them the energy that the way gives,
/// v^2 = v0^2 + 2 a . way, and it passes the shares in the order of time.
TEST(MotionBetween, OnATurningSlideHasTheEnergyOfItsWay) {
  Numbers numbers(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 v0 = numbers.vector(2.0), a = numbers.vector(4.0);
    const double duration = numbers.uniform(0.05, 1.0) * 0.5 * v0.norm() / a.norm();  // turns by 30 degrees at most
    const auto [from, to] = piece(v0, a, duration);
    const Vec3 way = to.motion.position - from.motion.position;
    EXPECT_LT((motion_between(from, to, 0.0).velocity - v0).norm(), 1e-9);
    EXPECT_LT((motion_between(from, to, 1.0).velocity - v0 - duration * a).norm(), 1e-9);
    EXPECT_NEAR(motion_between(from, to, 1.0).time, to.motion.time, 1e-9);
    double before = from.motion.time;
    for (const double share : {0.1, 0.5, 0.9, 1.0}) {
      const Motion m = motion_between(from, to, share);
      EXPECT_NEAR(m.velocity.squaredNorm(), v0.squaredNorm() + 2.0 * share * a.dot(way), 1e-9);
      EXPECT_GT(m.time, before);
      before = m.time;
    }
  }
}

/// A piece that is cut off at a place, as at a barrier, is the first part of the whole piece.
TEST(MotionBetween, OfAPieceThatIsCutOff) {
  for (const double v0 : {0.0, 2.0}) {
    const auto [from, to] = piece({v0, 0.0, -v0}, {1.5, 0.0, -1.5}, 1.2);
    const Vertex cut{motion_between(from, to, 0.4), Event::Barrier};
    for (const double share : {0.0, 0.3, 1.0}) {
      const Motion part = motion_between(from, cut, share), whole = motion_between(from, to, 0.4 * share);
      EXPECT_NEAR(part.time, whole.time, 1e-12);
      EXPECT_LT((part.velocity - whole.velocity).norm(), 1e-12);
      EXPECT_LT((part.position - whole.position).norm(), 1e-12);
    }
  }
}

TEST(MotionBetween, OfAPieceWithoutWayOrTimeIsFinite) {
  for (const double duration : {0.0, 0.5})
    for (const double way : {0.0, 1e-9}) {
      const Vertex from{{1.0, {5.0, 5.0, 5.0}, {1.0, 0.0, 0.0}, Vec3::Zero()}, Event::Slide};
      Vertex to = from;
      to.motion.time += duration;
      to.motion.position.x() += way;
      for (const double share : {0.0, 0.5, 1.0}) {
        const Motion m = motion_between(from, to, share);
        EXPECT_TRUE(m.position.allFinite() && m.velocity.allFinite());
        EXPECT_GE(m.time, from.motion.time);
        EXPECT_LE(m.time, to.motion.time);
      }
    }
}

/// A flight has a constant velocity in plan: the share of the way is that of the time.
TEST(MotionBetween, InAFlightTheShareOfTheWayIsThatOfTheTime) {
  const Vertex from{{2.0, {0.0, 0.0, 100.0}, {4.0, 3.0, 1.0}, Vec3::Zero()}, Event::Impact};
  Vertex to = from;
  to.motion.time = 4.0;
  to.motion.position = {8.0, 6.0, 100.0 + 2.0 - 0.5 * 9.81 * 4.0};
  const Motion m = motion_between(from, to, 0.25);
  EXPECT_DOUBLE_EQ(m.time, 2.5);
  EXPECT_LT((m.position - Vec3(2.0, 1.5, 100.0 + 0.5 - 0.5 * 9.81 * 0.25)).norm(), 1e-12);
  EXPECT_LT((m.velocity - Vec3(4.0, 3.0, 1.0 - 9.81 * 0.5)).norm(), 1e-12);
}

/// Without friction v^2/2 + g z stays as it was at the start, at every place of every piece: on walls, across the
/// bottom of a gully and along it, where a block that came down the wall turns by up to 90 degrees and keeps its speed.
TEST(MotionBetween, EveryPlaceOfASlideHasTheEnergyOfItsHeight) {
  const Surface surface(test::terrain(test::grid_of(90, 61, 2.0, 2.0),
                                      [&](double x, double y) { return 300.0 - 1.0 * x + 2.0 * std::abs(y - 61.0); }));
  const Cover cover{{Ground{.tan_phi = 0.0}}, {}};
  int along = 0;
  for (const double beside : {0.0, 1e-4, 0.3})
    for (const Eigen::Vector2d& v : {Eigen::Vector2d(0.0, -0.1), {0.0, -2.0}, {1.0, -1.0}, {0.01, 0.0}}) {
      Motion motion;
      motion.position = {50.3, 61.0 + beside, *surface.height(50.3, 61.0 + beside)};
      motion.velocity = {v.x(), v.y(), -v.x() + 2.0 * v.y()};
      const double energy = 0.5 * motion.velocity.squaredNorm() + kGravity * motion.position.z();
      PatchIndex at = surface.patch_at(50.3, 61.0 + beside);
      Path path;
      slide(surface, cover, motion, at, {6.0}, 0.5, path);
      path.vertices.push_back({motion, Event::End});
      for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
        const Vertex &from = path.vertices[i], &to = path.vertices[i + 1];
        if ((to.motion.position - from.motion.position).norm() < 1e-3) continue;  // digits of the way
        const bool on_the_bottom = std::abs(from.motion.position.y() - 61.0) < 1e-9;
        along += on_the_bottom && std::abs(to.motion.position.y() - 61.0) < 1e-9 ? 1 : 0;
        for (const double share : {0.0, 0.1, 0.5, 1.0}) {
          const Motion m = motion_between(from, to, share);
          EXPECT_NEAR(0.5 * m.velocity.squaredNorm() + kGravity * m.position.z(), energy, 0.01) << i << ' ' << share;
        }
      }
    }
  EXPECT_GT(along, 10) << "otherwise this test says nothing of the bottom";
}

}  // namespace
}  // namespace talus
