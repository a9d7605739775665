#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/slopes.hpp"

/// Mechanical energy along whole trajectories on random terrain: over flights, impacts and slides it never grows.
namespace talus {
namespace {

using test::Numbers;

/// Height [m] that the block would reach if all its energy, that of its spin too, were turned into height.
double height_of_energy(const Motion& motion, double radius) {
  const double spin = 0.4 * radius * radius * motion.spin.squaredNorm();  // I = 2/5 m R^2
  return motion.position.z() + (motion.velocity.squaredNorm() + spin) / (2.0 * kGravity);
}

/// Largest growth of energy from one vertex of a path to a later one, as height [m].
double largest_gain(const Path& path, double radius) {
  double lowest = height_of_energy(path.vertices.front().motion, radius), gain = 0.0;
  for (const Vertex& vertex : path.vertices) {
    const double height = height_of_energy(vertex.motion, radius);
    gain = std::max(gain, height - lowest);
    lowest = std::min(lowest, height);
  }
  return gain;
}

/// Cells of random height on a slope: gradients up to 3 and more, every patch twisted.
Raster<float> random_terrain(std::uint64_t seed, double cell) {
  Numbers numbers(seed);
  return test::terrain(test::grid_of(50, 40, cell, cell),
                       [&](double x, double) { return 500.0 - 0.8 * x + cell * numbers.uniform(0.0, 3.0); });
}

TEST(Energy, NeverGrowsOnRandomTerrain) {
  Numbers numbers(20);
  int slid = 0;
  for (const double tan_phi : {0.0, 0.3, 1.0 / std::sqrt(3.0)})
    for (const double cell : {0.5, 2.0, 10.0})
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Surface surface(random_terrain(seed, cell));
        const Cover cover{{Ground{.theta_scale = 0.5, .psi_scale = 0.5, .En50 = 5.0, .tan_phi = tan_phi}}, {}};
        const World world{surface, cover, {}, {.time_limit = 60.0, .impact_limit = 2000}};
        for (std::uint32_t block = 0; block < 150; ++block) {
          const double x = numbers.uniform(0.1, 0.9) * 50.0 * cell, y = numbers.uniform(0.1, 0.9) * 40.0 * cell;
          const double diameter = numbers.uniform(0.2, 3.0);
          Path path;
          trace(world, test::block_at({x, y, *surface.height(x, y) + 1.0}, numbers.vector(3.0), diameter, block), path);
          slid += std::ranges::count(path.vertices, Event::Slide, &Vertex::event) > 0 ? 1 : 0;
          ASSERT_LT(largest_gain(path, 0.5 * diameter), 1e-7)
              << "tan(phi) " << tan_phi << ", cells of " << cell << " m, seed " << seed << ", block " << block;
        }
      }
  EXPECT_GT(slid, 1000);  // of 5400 trajectories
}

}  // namespace
}  // namespace talus
