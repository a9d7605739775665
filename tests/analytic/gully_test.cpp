#include <gtest/gtest.h>

#include "support/slopes.hpp"
#include "talus/physics/trace.hpp"

namespace talus {
namespace {

using test::kUpperTalus;
constexpr std::uint32_t kBlocksPerGully = 200;
constexpr double kWay = 200.0;  // [m]

/// A straight V gully, floor 35 degrees, walls 45, that leads from its first place at an angle to the grid.
struct Gully {
  double cell, angle, offset;

  Eigen::Vector2d way() const { return {std::cos(angle), std::sin(angle)}; }
  Eigen::Vector2d start() const { return {30.5 * cell, (30.5 + offset) * cell}; }
  Surface surface(SurfaceKind kind) const {
    const int cells = static_cast<int>(300.0 / cell) + 60;
    return Surface(test::terrain(test::grid_of(cells, cells, cell, cell),
                                 [&](double x, double y) {
                                   const Eigen::Vector2d d = Eigen::Vector2d(x, y) - start();
                                   const double across = d.y() * way().x() - d.x() * way().y();
                                   return 500.0 - std::tan(radians(35.0)) * d.dot(way()) + std::abs(across);
                                 }),
                   kind);
  }

  /// Share of the blocks, released 1 m above the thalweg, that stop before they have gone kWay down it.
  double stopping(SurfaceKind kind) const {
    const Surface terrain = surface(kind);
    const Cover cover{{kUpperTalus}, {}};
    const double height = *terrain.height(start().x(), start().y()) + 1.0;
    int stopped = 0;
    for (std::uint32_t block = 0; block < kBlocksPerGully; ++block) {
      Path path;
      trace({terrain, cover, {}, {}}, test::block_at({start().x(), start().y(), height}, Vec3::Zero(), 1.0, block),
            path);
      const Eigen::Vector2d end = path.vertices.back().motion.position.head<2>();
      const bool stays = path.end == End::Stopped || path.end == End::Trapped;
      stopped += stays && (end - start()).dot(way()) < kWay ? 1 : 0;
    }
    return 1.0 * stopped / kBlocksPerGully;
  }
};

TEST(DiagonalGully, HoldsNoBlockThatTheSameGullyAlongTheGridLetsPass) {
  for (const double cell : {5.0, 2.0}) {
    EXPECT_EQ((Gully{cell, 0.0, 0.0}.stopping(SurfaceKind::Creased)), 0.0);
    for (const double offset : {0.0, 0.5})
      EXPECT_LE((Gully{cell, kPi / 4, offset}.stopping(SurfaceKind::Creased)), 0.02) << cell << ' ' << offset;
    EXPECT_GT((Gully{cell, kPi / 4, 0.0}.stopping(SurfaceKind::Bilinear)), 0.5) << cell;  // the dams
  }
}

TEST(DiagonalGully, AlongTheGridIsTheSameOnBothSurfacesToTheBit) {
  const Gully gully{5.0, 0.0, 0.0};
  const Surface bilinear = gully.surface(SurfaceKind::Bilinear), creased = gully.surface(SurfaceKind::Creased);
  const Cover cover{{kUpperTalus}, {}};
  for (std::uint32_t block = 0; block < 50; ++block) {
    const Release release = test::block_at({gully.start().x(), gully.start().y(), 502.0}, Vec3::Zero(), 1.0, block);
    Path a, b;
    trace({bilinear, cover, {}, {}}, release, a);
    trace({creased, cover, {}, {}}, release, b);
    EXPECT_EQ(a.vertices.back().motion.position, b.vertices.back().motion.position);
    EXPECT_EQ(a.length, b.length);
  }
}

}  // namespace
}  // namespace talus
