#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/slopes.hpp"
#include "talus/physics/trace.hpp"

namespace talus {
namespace {

using test::Moments;
using test::Numbers;

using test::kUpperTalus;

/// One of the eight orientations of a square map: k quarter turns, with or without a mirroring of x before them.
struct Placement {
  int quarters;
  bool mirrored;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  // of the sources from the cell centres [m]

  /// A vector of the scene as it lies in the turned map.
  Eigen::Vector2d turn(Eigen::Vector2d v) const {
    if (mirrored) v.x() = -v.x();
    for (int i = 0; i < quarters; ++i) v = {-v.y(), v.x()};
    return v;
  }
  Eigen::Vector2d back(Eigen::Vector2d v) const {
    for (int i = 0; i < quarters; ++i) v = {v.y(), -v.x()};
    if (mirrored) v.x() = -v.x();
    return v;
  }
};

constexpr int kCells = 121;
constexpr double kCell = 5.0;
const Eigen::Vector2d kMiddle(kCells* kCell / 2, kCells* kCell / 2);

/// A rough valley side of 5 m cells, and the same turned.
Raster<float> valley() {
  Numbers numbers(21);
  return test::terrain(test::grid_of(kCells, kCells, kCell, kCell), [&](double x, double y) {
    return 900.0 - 0.85 * x + 25.0 * std::sin(0.03 * y) + numbers.uniform(0.0, 3.0) +
           (x > 380.0 ? 0.6 * (x - 380.0) : 0.0);
  });
}
Raster<float> placed(const Raster<float>& heights, const Placement& placement) {
  return test::terrain(heights.grid, [&](double x, double y) {
    const Eigen::Vector2d from = kMiddle + placement.back(Eigen::Vector2d(x, y) - kMiddle);
    return heights.at(heights.grid.column_of(from.x()), heights.grid.row_of(from.y()));
  });
}

struct Statistics {
  Moments runout, sideways, time, impacts, speed, rise, spin;
  int stopped = 0;
};

/// Paths of blocks in the turned map. Releases are turned into the map, the paths are turned back.
std::vector<Path> trajectories(const Raster<float>& scene, const Placement& placement, std::uint64_t seed,
                               std::uint32_t count, SurfaceKind kind = SurfaceKind::Bilinear) {
  const Surface surface(placed(scene, placement), kind);
  const Cover cover{{kUpperTalus}, {}};
  std::vector<Path> paths(count);
  for (std::uint32_t block = 0; block < count; ++block) {
    // Cell centres, as sources are, unless shifted: there the patch in the north-east is the one that counts.
    const Eigen::Vector2d source =
        Eigen::Vector2d(12.5 + 5.0 * (block % 8), 252.5 + 5.0 * (block / 8 % 20)) + placement.shift;
    const Eigen::Vector2d there = kMiddle + placement.turn(source - kMiddle);
    Release release;
    release.seed = seed;
    release.block = block;
    release.body = block_of(1.0, 2700.0);
    release.motion.position = {there.x(), there.y(), test::height_between_centres(scene, source.x(), source.y()) + 2.0};
    trace({surface, cover, {}, {.impact_limit = 5000}}, release, paths[block]);
  }
  return paths;
}

Statistics statistics(const std::vector<Path>& paths, const Placement& placement) {
  Statistics s;
  for (std::size_t block = 0; block < paths.size(); ++block) {
    const Path& path = paths[block];
    const Motion& last = path.vertices.back().motion;
    const Eigen::Vector2d end = kMiddle + placement.back(last.position.head<2>() - kMiddle);
    const double row = 252.5 + 5.0 * static_cast<double>(block / 8 % 20);
    s.runout.add(end.x());
    s.sideways.add(end.y() - row);
    s.time.add(last.time);
    s.impacts.add(path.impacts);
    double fastest = 0.0, steepest = 0.0, spin = 0.0;
    for (const Vertex& v : path.vertices) {
      fastest = std::max(fastest, v.motion.velocity.norm());
      steepest = std::max(steepest, v.motion.velocity.z());
      spin = std::max(spin, v.motion.spin.norm());
    }
    s.speed.add(fastest), s.rise.add(steepest), s.spin.add(spin);
    s.stopped += rests(path.end) ? 1 : 0;
  }
  return s;
}

void expect_equal(const Statistics& a, const Statistics& b, const char* what) {
  const auto compare = [&](const Moments& x, const Moments& y, const char* name) {
    EXPECT_NEAR(x.mean(), y.mean(), 5.0 * std::hypot(x.error(), y.error())) << what << ": " << name;
  };
  compare(a.runout, b.runout, "runout");
  compare(a.sideways, b.sideways, "sideways");
  compare(a.time, b.time, "time");
  compare(a.impacts, b.impacts, "impacts");
  compare(a.speed, b.speed, "speed");
  compare(a.rise, b.rise, "rise");
  compare(a.spin, b.spin, "spin");
  const double n = a.runout.count, p = a.stopped / n, q = b.stopped / n;
  EXPECT_NEAR(p, q, 5.0 * std::sqrt((p * (1 - p) + q * (1 - q)) / n)) << what << ": stopped";
}

TEST(SceneSymmetry, QuarterTurnsAndMirroringChangeNoStatistic) {
  const Raster<float> scene = valley();
  constexpr std::uint32_t kBlocks = 4000;
  const Statistics reference = statistics(trajectories(scene, {0, false}, 1, kBlocks), {0, false});
  EXPECT_GT(reference.impacts.mean(), 10.0);
  for (const bool mirrored : {false, true})
    for (int quarters = 0; quarters < 4; ++quarters) {
      const Placement placement{quarters, mirrored};
      expect_equal(reference, statistics(trajectories(scene, placement, 2 + quarters, kBlocks), placement),
                   mirrored ? "mirrored" : "turned");
    }
}

TEST(SceneSymmetry, HoldsOnACreasedSurfaceToo) {
  const Raster<float> scene = valley();
  constexpr std::uint32_t kBlocks = 4000;
  const auto on_creases = [&](const Placement& placement, std::uint64_t seed) {
    return statistics(trajectories(scene, placement, seed, kBlocks, SurfaceKind::Creased), placement);
  };
  const Statistics reference = on_creases({0, false}, 1);
  const Statistics bilinear = statistics(trajectories(scene, {0, false}, 1, kBlocks), {0, false});
  EXPECT_NE(reference.runout.mean(), bilinear.runout.mean());  // there are creases
  for (const bool mirrored : {false, true})
    for (int quarters = 0; quarters < 4; ++quarters)
      expect_equal(reference, on_creases({quarters, mirrored}, 2 + quarters), mirrored ? "mirrored" : "turned");
}

class PathSymmetry : public testing::TestWithParam<SurfaceKind> {};

TEST_P(PathSymmetry, AQuarterTurnTurnsEveryPath) {  // the same draws: the same path, until rounding has grown
  const Raster<float> scene = valley();
  constexpr std::uint32_t kBlocks = 400;
  const Eigen::Vector2d shift(1.3, 0.7);
  const auto reference = trajectories(scene, {0, false, shift}, 1, kBlocks, GetParam());
  for (int quarters = 1; quarters < 4; ++quarters) {
    const Placement placement{quarters, false, shift};
    const auto turned = trajectories(scene, placement, 1, kBlocks, GetParam());
    int same = 0;
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
      bool close = true;
      for (std::size_t i = 0; close && i < 8 && i < reference[block].vertices.size(); ++i) {
        if (i >= turned[block].vertices.size()) {
          close = false;
          break;
        }
        const Motion &a = reference[block].vertices[i].motion, &b = turned[block].vertices[i].motion;
        close = (placement.back(b.velocity.head<2>()) - a.velocity.head<2>()).norm() < 1e-6 &&
                std::abs(a.time - b.time) < 1e-6;
      }
      same += close ? 1 : 0;
    }
    EXPECT_GT(same, 0.97 * kBlocks) << quarters;
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, PathSymmetry, testing::Values(SurfaceKind::Bilinear, SurfaceKind::Creased),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST(SceneSymmetry, AnyTurnOfAPlaneTurnsEveryPath) {
  const auto run = [](double azimuth, std::uint32_t block) {  // dips towards the azimuth
    const Eigen::Vector2d dip(std::cos(azimuth), std::sin(azimuth));
    const double extent = 4 * 4096.0;
    const Surface surface(test::terrain(test::grid_of(4, 4, 4096.0, 4096.0), [&](double x, double y) {
      return -0.78125 * (dip.x() * (x - extent / 2) + dip.y() * (y - extent / 2));
    }));
    const Cover cover{{kUpperTalus}, {}};
    Release release;
    release.block = block;
    release.body = block_of(1.0, 2700.0);
    release.motion.position = {extent / 2, extent / 2, 2.0};
    Path path;
    trace({surface, cover, {}, {.impact_limit = 12}}, release, path);
    return path;
  };
  int compared = 0;
  for (std::uint32_t block = 0; block < 60; ++block) {
    const Path reference = run(0.0, block);
    for (const double azimuth : {0.3, 1.5707, 2.2, 4.0, 5.9}) {
      const Path turned = run(azimuth, block);
      const Eigen::Matrix3d back = Eigen::AngleAxisd(-azimuth, Vec3::UnitZ()).toRotationMatrix();
      for (std::size_t i = 0; i < std::min(reference.vertices.size(), turned.vertices.size()); ++i) {
        const Motion &a = reference.vertices[i].motion, &b = turned.vertices[i].motion;
        if ((back * b.velocity - a.velocity).norm() > 1e-3) break;  // slides meet edges elsewhere; floats round heights
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 60 * 5 * 10);
}

}  // namespace
}  // namespace talus
