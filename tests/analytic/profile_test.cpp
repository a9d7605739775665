#include "talus/terrain/profile.hpp"

#include <gtest/gtest.h>

#include "support/slopes.hpp"

namespace talus {
namespace {

// Table 1 of the paper; the 2D model has no sideways tilt.
constexpr Ground kTalus{.theta_scale = 0.7, .En50 = 15.0, .Et50 = 50.0, .shape_min = 1.0, .shape_max = 1.5};

/// 0.75 m/m down to x = 150, a bench of 5 m, 0.5 m/m to x = 300, flat: short binary fractions, so floats hold them.
Profile bench() {
  return {{{0.0, 200.0}, {150.0, 87.5}, {155.0, 87.5}, {300.0, 15.0}, {400.0, 15.0}}};
}

struct Scene {
  Surface surface;
  Cover cover{{kTalus}, {}};
  bool in_plane = false;

  Path run(const Vec3& position, const Vec3& velocity, std::uint32_t block) const {
    Path path;
    trace({surface, cover, {.in_plane = in_plane}, {}}, test::block_at(position, velocity, 1.2, block), path);
    return path;
  }
};

Scene on_profile(const Profile& profile, double step = 0.5) {
  return {Surface(extrude(profile, step).heights), {{kTalus}, {}}, true};
}

TEST(ProfileOf2D, IsThe3DModelInAVerticalPlaneBitForBit) {
  const double step = 0.5, datum = extrude(bench(), step).datum;
  const Scene flat = on_profile(bench(), step);
  // The same ground as a DEM of 801 x 30 cells of 0.5 m x 3 m: other rows, other place across.
  const Scene space{Surface(test::terrain(test::grid_of(801, 30, step, 3.0),
                                          [&](double x, double) { return bench().height(x - 0.5 * step) - datum; }))};
  for (std::uint32_t block = 0; block < 100; ++block) {
    const double z = *flat.surface.height(20.0, kProfileLine) + 2.0;
    const Path a = flat.run({20.0, kProfileLine, z}, Vec3(1, 0, 0), block);
    const Path b = space.run({20.0, 40.0, z}, Vec3(1, 0, 0), block);
    ASSERT_EQ(a.vertices.size(), b.vertices.size()) << block;
    ASSERT_EQ(a.end, b.end);
    ASSERT_GT(a.impacts, 5U);
    for (std::size_t i = 0; i < a.vertices.size(); ++i) {
      const Motion &m = a.vertices[i].motion, &n = b.vertices[i].motion;
      ASSERT_EQ(m.position.x(), n.position.x()) << block << ' ' << i;
      ASSERT_EQ(m.position.z(), n.position.z());
      ASSERT_EQ(m.velocity, n.velocity);
      ASSERT_EQ(m.spin, n.spin);
    }
  }
}

TEST(ProfileOf2D, NoBlockEverLeavesThePlane) {  // also straight down on flat ground, and in a sharp valley
  const Profile valley{{{0.0, 60.0}, {50.0, 60.0}, {80.0, 20.0}, {100.0, 60.0}, {140.0, 60.0}}};
  const Scene scene = on_profile(valley, 0.1);
  int east = 0, west = 0;
  for (std::uint32_t block = 0; block < 300; ++block) {
    const double x = block % 3 == 0 ? 20.0 : 40.0 + 0.2 * block;
    const Path path = scene.run({x, kProfileLine, *scene.surface.height(x, kProfileLine) + 5.0}, Vec3::Zero(), block);
    for (const Vertex& v : path.vertices) {
      ASSERT_EQ(v.motion.position.y(), kProfileLine) << block;
      ASSERT_EQ(v.motion.velocity.y(), 0.0) << block;
      ASSERT_EQ(v.motion.spin.x(), 0.0) << block;
      ASSERT_EQ(v.motion.spin.z(), 0.0) << block;
    }
    ASSERT_NE(path.end, End::Limit);
    if (x != 20.0) continue;
    const double after = path.vertices[1].motion.velocity.x();  // the rebound from flat ground, to either side
    east += after > 0.0 ? 1 : 0;
    west += after < 0.0 ? 1 : 0;
  }
  EXPECT_GT(east, 25);  // of 100, less those without roughness; fair coin: 5 standard errors
  EXPECT_GT(west, 25);
}

TEST(ProfileOf2D, AMirroredProfileGivesMirroredPaths) {
  Profile mirrored;
  const Profile profile = bench();
  for (auto node = profile.nodes.rbegin(); node != profile.nodes.rend(); ++node)
    mirrored.nodes.emplace_back(400.0 - node->x(), node->y());
  const Scene a = on_profile(profile), b = on_profile(mirrored);
  const double width = a.surface.grid().width();
  for (std::uint32_t block = 0; block < 100; ++block) {
    const Vec3 start(20.0, kProfileLine, *a.surface.height(20.0, kProfileLine) + 2.0);
    const Path p = a.run(start, Vec3(1, 0, 0), block);
    const Path q = b.run({width - 20.0, kProfileLine, start.z()}, Vec3(-1, 0, 0), block);
    ASSERT_EQ(p.vertices.size(), q.vertices.size()) << block;
    for (std::size_t i = 0; i < p.vertices.size(); ++i) {
      ASSERT_NEAR(p.vertices[i].motion.position.x(), width - q.vertices[i].motion.position.x(), 1e-6) << block;
      ASSERT_NEAR(p.vertices[i].motion.velocity.x(), -q.vertices[i].motion.velocity.x(), 1e-6) << block;
      ASSERT_NEAR(p.vertices[i].motion.velocity.z(), q.vertices[i].motion.velocity.z(), 1e-6) << block;
    }
  }
}

}  // namespace
}  // namespace talus
