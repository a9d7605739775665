// Blocks in a straight gully that runs diagonally to the grid and falls by 35 degrees everywhere, more than phi = 30:
// none may stop, as on the terrain of the program.
#include <cmath>
#include <cstdio>
#include <talus/talus.hpp>
#include <vector>

int main() {
  const talus::Grid grid{.columns = 150, .rows = 150, .cell_x = 2.0, .cell_y = 2.0};
  std::vector<float> heights;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double along = std::sqrt(2.0) * (column + row), across = std::sqrt(2.0) * (column - row);  // [m]
      heights.push_back(static_cast<float>(0.70 * along + std::abs(across)));
    }
  const talus::Surface surface(talus::Raster<float>(grid, heights));
  const talus::Cover cover{{talus::Ground{.theta_scale = 1.0, .psi_scale = 0.9, .shape_max = 1.4}}, {}};
  constexpr unsigned kBlocks = 100;
  unsigned left = 0;
  talus::Path path;
  for (unsigned block = 0; block < kBlocks; ++block) {
    talus::Release release;
    release.block = block;
    release.body = talus::block_of(1.0, 2700.0);
    release.motion.position = {271.0, 271.0, surface.height(271.0, 271.0).value() + 1.0};
    talus::trace({surface, cover, {}, {}}, release, path);
    left += path.end == talus::End::Left ? 1U : 0U;
  }
  std::printf("%u of %u blocks leave the gully\n", left, kBlocks);
  return left == kBlocks ? 0 : 1;
}
