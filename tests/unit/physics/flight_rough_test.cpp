#include <gtest/gtest.h>

#include "support/scenes.hpp"
#include "talus/physics/flight.hpp"

namespace talus {
namespace {

using test::Numbers;

/// A rough surface with cells that are not square, and a parabola over it: independent of the engine's walk.
struct RoughScene {
  Surface surface;
  Vec3 start = Vec3::Zero(), velocity = Vec3::Zero();

  double height(double x, double y) const {
    return surface.creased() ? test::height_on_creases(surface.heights(), x, y)
                             : test::height_between_centres(surface.heights(), x, y);
  }
  Vec3 place(double t) const { return start + t * velocity - Vec3(0, 0, 0.5 * kGravity * t * t); }
  double clearance(double t) const {
    const Vec3 p = place(t);
    return p.z() - height(p.x(), p.y());
  }
  /// First time below the ground, by steps of `step` and bisection.
  double landing(double step) const {
    double t = 0.0;
    while (clearance(t + step) > 0.0) t += step;
    double low = t, high = t + step;
    for (int i = 0; i < 60; ++i) (clearance(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  }
};

struct Cells {
  double x, y;
  SurfaceKind kind;
};

/// "creased_200_by_300_cm".
std::string name_of_test(const testing::TestParamInfo<Cells>& info) {
  const auto cm = [](double metres) { return std::to_string(static_cast<int>(100.0 * metres)); };
  return std::string(name_of(info.param.kind)) + "_" + cm(info.param.x) + "_by_" + cm(info.param.y) + "_cm";
}

RoughScene rough(Numbers& numbers, const Cells& cells) {
  return {
      Surface(test::terrain(test::grid_of(80, 60, cells.x, cells.y),
                            [&](double x, double) { return 500.0 - 0.5 * x + numbers.uniform(0.0, 2.0 * cells.x); }),
              cells.kind)};
}

void throw_block(RoughScene& scene, Numbers& numbers) {
  const Grid& grid = scene.surface.grid();
  const double x = numbers.uniform(0.3, 0.7) * grid.width(), y = numbers.uniform(0.3, 0.7) * grid.height();
  scene.start = {x, y, scene.height(x, y) + numbers.uniform(0.0, 4.0)};
  const double fast = std::min(20.0, 0.1 * std::min(grid.width(), grid.height()));
  scene.velocity = {numbers.uniform(-fast, fast), numbers.uniform(-fast, fast), numbers.uniform(-3, 4)};
}

class RoughFlight : public testing::TestWithParam<Cells> {};

TEST_P(RoughFlight, LandsWhereSteppingAndBisectionLand) {
  Numbers numbers(11);
  RoughScene scene = rough(numbers, GetParam());
  int grazed = 0, flights = 0;
  for (; flights < 1500; ++flights) {
    throw_block(scene, numbers);
    Motion motion{0.0, scene.start, scene.velocity, Vec3::Zero()};
    PatchIndex at = scene.surface.patch_at(scene.start.x(), scene.start.y());
    Path path;
    ASSERT_EQ(fly(scene.surface, motion, at, false, path), FlightEnd::Landed);
    ASSERT_LT((motion.position - scene.place(motion.time)).norm(), 1e-10);
    ASSERT_NEAR(scene.clearance(motion.time), 0.0, 1e-10);
    const PatchIndex there = scene.surface.patch_at(motion.position.x() - 1e-12, motion.position.y() - 1e-12);
    ASSERT_LE(std::abs(there.column - at.column) + std::abs(there.row - at.row), 1);
    const double landing = scene.landing(5e-4);
    if (motion.time < landing - 1e-9)
      ++grazed;  // touched a crest for less than a step: its clearance is 0 all the same
    else
      ASSERT_NEAR(motion.time, landing, 1e-9);
  }
  EXPECT_LT(grazed, flights / 100);
}

TEST_P(RoughFlight, SpansFollowEachOtherAndTheGroundAndAreNeverBelowIt) {
  Numbers numbers(12);
  RoughScene scene = rough(numbers, GetParam());
  const Surface& surface = scene.surface;
  int halves = 0;  // passages from one half of a patch to the other
  for (int i = 0; i < 500; ++i) {
    throw_block(scene, numbers);
    Motion motion{3.0, scene.start, scene.velocity, Vec3(1, 2, 3)};
    PatchIndex at = surface.patch_at(scene.start.x(), scene.start.y());
    Path path;
    fly(surface, motion, at, false, path);
    EXPECT_EQ(motion.spin, Vec3(1, 2, 3));
    double t = 0.0;
    for (std::size_t k = 0; k < path.spans.size(); ++k) {
      const Span& s = path.spans[k];
      const double duration = (s.rise_from - s.rise_to) / kGravity;
      ASSERT_NEAR(s.plan_speed_squared, scene.velocity.head<2>().squaredNorm(), 1e-5 * s.plan_speed_squared);
      for (const double share : {0.0, 0.2, 0.5, 0.8, 1.0}) {  // place, height and clearance against the parabola itself
        const Vec3 p = scene.place(t + share * duration);
        ASSERT_NEAR(surface.x_of(1.0 * s.patch.column + s.p_from + share * (s.p_to - s.p_from)), p.x(), 2e-4);
        ASSERT_NEAR(surface.y_of(1.0 * s.patch.row + s.q_from + share * (s.q_to - s.q_from)), p.y(), 2e-4);
        const double height = s.height_from + share * ((s.height_to - s.height_from) - s.bend * (1.0 - share));
        ASSERT_NEAR(height, scene.clearance(t + share * duration), 2e-3);
        ASSERT_GT(height, -1e-5);
        ASSERT_GT(scene.clearance(std::min(t + share * duration, motion.time - 3.0)), -1e-9);
      }
      for (const float share : {s.p_from, s.q_from, s.p_to, s.q_to})
        ASSERT_TRUE(share > -1e-5F && share < 1.0F + 1e-5F);
      if (k > 0) {  // one patch at a time, where and when the last one ended
        const Span& last = path.spans[k - 1];
        const int steps = std::abs(s.patch.column - last.patch.column) + std::abs(s.patch.row - last.patch.row);
        ASSERT_TRUE(steps == 1 || (steps == 0 && surface.creased())) << steps;  // the other half of the patch
        halves += 1 - steps;
        ASSERT_NEAR(1.0 * s.patch.column + s.p_from, 1.0 * last.patch.column + last.p_to, 1e-4);
        ASSERT_NEAR(1.0 * s.patch.row + s.q_from, 1.0 * last.patch.row + last.q_to, 1e-4);
        ASSERT_EQ(s.rise_from, last.rise_to);
        ASSERT_NEAR(s.height_from, last.height_to, 1e-4);
      }
      t += duration;
    }
    ASSERT_NEAR(t, motion.time - 3.0, 1e-5 * (1.0 + t));
    ASSERT_EQ(path.spans.back().patch, at);
  }
  EXPECT_EQ(halves > 100, surface.creased());
}

INSTANTIATE_TEST_SUITE_P(Cells, RoughFlight,
                         testing::Values(Cells{0.5, 0.5, SurfaceKind::Bilinear}, Cells{2.0, 3.0, SurfaceKind::Bilinear},
                                         Cells{25.0, 10.0, SurfaceKind::Bilinear},
                                         Cells{2.0, 2.0, SurfaceKind::Creased}, Cells{2.0, 3.0, SurfaceKind::Creased}),
                         name_of_test);

TEST(FlightLength, IsTheArcLengthOfTheParabola) {
  const Surface surface(test::terrain(test::grid_of(100, 9, 2.0, 2.0), [](double, double) { return 0.0; }));
  for (const auto& [plan, up] : {std::pair{20.0, 5.0}, {10.0, 10.0}, {8.0, 1.0}}) {
    Motion motion{0.0, {20.0, 8.5, 0.0}, {plan, 0.0, up}, Vec3::Zero()};
    PatchIndex at = surface.patch_at(20.0, 8.5);
    Path path;
    ASSERT_EQ(fly(surface, motion, at, true, path), FlightEnd::Landed);
    const auto primitive = [plan = plan](double w) {
      return 0.5 * (w * std::hypot(plan, w) + plan * plan * std::asinh(w / plan));
    };
    EXPECT_NEAR(path.length, 2.0 * primitive(up) / kGravity, 2e-3 * path.length);  // three Gauss points
    EXPECT_NEAR(path.plan_length, plan * 2.0 * up / kGravity, 1e-12 * path.plan_length);
  }
}

}  // namespace
}  // namespace talus
