#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "support/scenes.hpp"
#include "talus/physics/trace.hpp"

namespace talus {
namespace {

// docs/validation.md, "The plane": a plane of 38 degrees, psi 0, Table 1 preset, D ~ U(1.0, 1.4) m, released at rest 2
// m above the ground; the state "where the flight crosses the level 140 m below the release point's ground". Read as:
// over the contour line of the plane on which the GROUND is 140 m lower than under the release; the jump is the
// vertical clearance there. (The other reading, the block itself at that height, gives 11.5 m/s for 10.2 and 5.8
// for 5.1, so it is not meant.)

constexpr std::uint32_t kBlocks = 20'000;
constexpr double kStart = 60.0, kDrop = 140.0;
const double kTanB = std::tan(radians(38.0));

Ground table1() {
  return {.theta_scale = 0.7, .En50 = 15.0, .Et50 = 50.0, .shape_min = 1.0, .shape_max = 1.5};
}

struct Sample {
  std::vector<double> speed, jump, spin;
  double mean_runout = 0.0;  // plan distance of the end from the release [m]

  static double mean(const std::vector<double>& x) {
    double sum = 0.0;
    for (const double v : x) sum += v;
    return sum / static_cast<double>(x.size());
  }
  static double p95(std::vector<double> x) {
    const auto at = x.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(x.size()));
    std::nth_element(x.begin(), at, x.end());
    return *at;
  }
};

/// State over the line x, on the parabola (or the piece of sliding) that crosses it; false where none does.
bool cross(const Path& path, double x, double ground, Sample& sample) {
  for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
    const Motion &from = path.vertices[i].motion, &to = path.vertices[i + 1].motion;
    if (from.position.x() > x || to.position.x() <= x) continue;
    const bool slides = path.vertices[i].event == Event::Slide;
    const double t = (x - from.position.x()) / from.velocity.x(), rise = from.velocity.z() - kGravity * t;
    if (slides) {
      sample.speed.push_back(from.velocity.norm());
      sample.jump.push_back(0.0);
    } else {
      sample.speed.push_back(std::sqrt(from.velocity.head<2>().squaredNorm() + rise * rise));
      sample.jump.push_back(from.position.z() + t * (from.velocity.z() - 0.5 * kGravity * t) - ground);
    }
    sample.spin.push_back(from.spin.norm());
    return true;
  }
  return false;
}

/// @param foot_drop  depth below the start at which a foot of 20 degrees begins, where blocks stop [m]
Sample run(const Ground& ground, const ImpactModel& model, std::uint32_t blocks = kBlocks, double foot_drop = 1e9) {
  const Surface surface(test::terrain(test::grid_of(foot_drop < 1e9 ? 1000 : 130, 3, 2.0, 64.0), [&](double x, double) {
    const double drop = kTanB * (x - kStart);
    return 500.0 - (drop < foot_drop ? drop : foot_drop + (drop - foot_drop) / kTanB * std::tan(radians(20.0)));
  }));
  const Cover cover{{ground}, {}};
  const double line = kStart + std::min(kDrop, 0.9 * foot_drop) / kTanB;
  test::Numbers numbers(77);
  Sample sample;
  Path path;
  for (std::uint32_t block = 0; block < blocks; ++block) {
    Release release;
    release.block = block;
    release.body = block_of(numbers.uniform(1.0, 1.4), 2700.0);
    release.motion.position = {kStart, 90.0, 502.0};
    trace({surface, cover, model, {}}, release, path);
    cross(path, line, *surface.height(line, 90.0), sample);
    sample.mean_runout += (path.vertices.back().motion.position.x() - kStart) / blocks;
  }
  return sample;
}

struct Row {
  double c;
  Roughness rule;
  double speed, speed95, jump, jump95;
};

TEST(PlaneTable, WithinThreePercent) {
  for (const Row& row : {Row{0.25, Roughness::Clamp, 10.2, 17.3, 1.31, 2.80},
                         {0.25, Roughness::Resample, 8.6, 14.5, 1.29, 2.40},
                         {1.0, Roughness::Clamp, 5.1, 8.6, 0.32, 0.70}}) {
    const Sample s = run(table1(), {row.c, row.rule});
    const double v = Sample::mean(s.speed), v95 = Sample::p95(s.speed), j = Sample::mean(s.jump),
                 j95 = Sample::p95(s.jump);
    std::printf("c %.2f %-8s %zu crossings: speed %.3f P95 %.3f jump %.4f P95 %.4f\n", row.c,
                row.rule == Roughness::Clamp ? "clamp" : "resample", s.speed.size(), v, v95, j, j95);
    EXPECT_NEAR(v, row.speed, 0.03 * row.speed);
    EXPECT_NEAR(v95, row.speed95, 0.03 * row.speed95);
    EXPECT_NEAR(j, row.jump, 0.03 * row.jump + 0.005);  // the table has two decimals
    EXPECT_NEAR(j95, row.jump95, 0.03 * row.jump95);
  }
}

TEST(PlaneScaling, SpeedGoesAsTheRootOfCAndJumpAsC) {  // once the start is forgotten
  const Sample quarter = run(table1(), {0.25, Roughness::Clamp}, 6000),
               one = run(table1(), {1.0, Roughness::Clamp}, 6000);
  EXPECT_NEAR(Sample::mean(quarter.speed) / Sample::mean(one.speed), 2.0,
              0.05);  // slow blocks feel the 0.1 m/s of sliding
  EXPECT_NEAR(Sample::mean(quarter.jump) / Sample::mean(one.jump), 4.0, 0.24);
}

TEST(PlaneScaling,
     IsExactForAScaledStart) {  // x -> 4 x, t -> 2 t, v -> 2 v, w -> 2 w for c -> c/4: powers of two, to rounding
  const auto trajectory = [](double c, double scale, std::uint32_t block) {
    const Surface surface(
        test::terrain(test::grid_of(8, 8, 4096.0, 4096.0), [](double x, double) { return -0.78125 * (x - 8192.0); }));
    const Cover cover{{table1()}, {}};
    Release release;
    release.block = block;
    release.body = block_of(1.2, 2700.0);
    release.motion.position = {8192.0, 10240.0, 2.0 * scale};
    release.motion.velocity = Vec3(1, 0.25, 0) * std::sqrt(scale);
    Path path;
    trace({surface, cover, {c, Roughness::Clamp}, {.impact_limit = 60}}, release, path);
    return path;
  };
  int compared = 0;
  for (std::uint32_t block = 0; block < 40; ++block) {
    const Path small = trajectory(1.0, 1.0, block), large = trajectory(0.25, 4.0, block);
    for (std::size_t i = 0; i < std::min(small.vertices.size(), large.vertices.size()); ++i) {
      const Vertex &a = small.vertices[i], &b = large.vertices[i];
      if (a.event == Event::Slide || b.event == Event::Slide) break;  // 0.1 m/s and D do not scale
      ASSERT_LT((b.motion.velocity - 2.0 * a.motion.velocity).norm(), 1e-8);
      ASSERT_LT((b.motion.spin - 2.0 * a.motion.spin).norm(), 1e-8);
      ASSERT_NEAR(b.motion.time, 2.0 * a.motion.time, 1e-8);
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

constexpr std::uint32_t kFew = 4000;

TEST(PlaneSigns, MoreRoughnessLessRunoutSpeedAndJump) {
  Ground rougher = table1();
  rougher.theta_scale = 1.0;
  const Sample a = run(table1(), {}, kFew, 140.0), b = run(rougher, {}, kFew, 140.0);
  EXPECT_LT(b.mean_runout, 0.98 * a.mean_runout);
  EXPECT_LT(Sample::mean(b.speed), 0.95 * Sample::mean(a.speed));
  EXPECT_LT(Sample::mean(b.jump), 0.98 * Sample::mean(a.jump));
}

TEST(PlaneSigns, MoreEn50MoreRunoutAndJump) {
  Ground harder = table1();
  harder.En50 = 30.0;
  const Sample a = run(table1(), {}, kFew, 140.0), b = run(harder, {}, kFew, 140.0);
  EXPECT_GT(b.mean_runout, 1.02 * a.mean_runout);
  EXPECT_GT(Sample::mean(b.jump), 1.05 * Sample::mean(a.jump));
}

TEST(PlaneSigns, TheShapeLowersRotationAndHardlyMovesSpeed) {
  Ground sphere = table1();
  sphere.shape_max = 1.0;
  const Sample a = run(table1(), {}, kFew), b = run(sphere, {}, kFew);
  EXPECT_LT(Sample::mean(a.spin), 0.9 * Sample::mean(b.spin));
  EXPECT_NEAR(Sample::mean(a.speed), Sample::mean(b.speed), 0.05 * Sample::mean(b.speed));
}

}  // namespace
}  // namespace talus
