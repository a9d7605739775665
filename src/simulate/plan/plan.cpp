#include "talus/simulate/plan/plan.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/elementary.hpp"
#include "talus/base/expect.hpp"
#include "talus/simulate/scenario/block_class.hpp"

namespace talus {
namespace {

/// Volume at a share, 0..1, of the power law N(>= V) = A V^-b between two bounds: the inverse of its distribution.
/// Equal bounds give that volume. Error: 1e-15 / b relative, hence the lower bound of `blocks.exponent`.
double volume_at(const VolumePowerLaw& law, double share) {
  const double low = power(law.volume.low, -law.exponent), high = power(law.volume.high, -law.exponent);
  return std::clamp(power(low - share * (low - high), -1.0 / law.exponent), law.volume.low, law.volume.high);
}

double diameter_at(const Blocks& blocks, double share_of_class, double share) {
  if (blocks.power_law.volume.high > 0.0) return diameter_of(volume_at(blocks.power_law, share));
  return blocks.classes[class_at(blocks.classes, share_of_class)].diameter.at(share);
}

}  // namespace

Release make_release(const Scenario& scenario, std::uint32_t source, std::uint32_t block) {
  TALUS_EXPECT(source < scenario.sources.size(), "a release has a source cell");
  const SourceCell& cell = scenario.sources[source];
  TALUS_EXPECT(cell.feature < scenario.features.size(), "a source cell belongs to a feature");
  const SourceFeature& feature = scenario.features[cell.feature];
  const Grid& grid = scenario.surface.grid();
  const Random random(scenario.seed, source, block, Purpose::Release);
  const auto place = random.words(0), size = random.words(1);
  const double x = cell.x + (uniform(place[0]) - 0.5) * (cell.point ? cell.along : grid.cell_x);
  const double y = cell.point ? cell.y : cell.y + (uniform(place[1]) - 0.5) * grid.cell_y;
  const double height = feature.release_height.at(uniform(place[2]));
  const double diameter = std::isnan(feature.diameter.low)
                              ? diameter_at(scenario.blocks, uniform(size[0]), uniform(size[1]))
                              : feature.diameter.at(uniform(size[1]));
  Release release;
  release.seed = scenario.seed;
  release.source = source;
  release.block = block;
  release.body = block_of(diameter, scenario.blocks.density);
  TALUS_EXPECT(release.body.mass > 0.0, "a block has a mass");
  release.body.axes = scenario.blocks.axes;
  release.day = scenario.day;
  release.motion.position = {x, y, scenario.surface.height(x, y).value_or(kNotGiven) + height};
  release.motion.velocity = feature.velocity;
  return release;
}

bool is_recorded(const Scenario& scenario, std::uint32_t source, std::uint32_t block) {
  // Release g is recorded if floor(g K / N) steps up after it: K of N releases, evenly spread. g K can exceed 64 bits.
  __extension__ typedef unsigned __int128 Wide;
  const Wide wanted = scenario.output.paths, all = scenario.released();
  const Wide g = std::uint64_t{source} * scenario.trajectories + block;
  TALUS_EXPECT(g < all, "a release is one of the plan");
  return (g + 1) * wanted / all > g * wanted / all;
}

}  // namespace talus
