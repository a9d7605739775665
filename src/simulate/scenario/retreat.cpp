#include "talus/simulate/scenario/retreat.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "talus/base/text.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus {
namespace {

/// Multiple of `kMuchRetreat` above which the warning comes: it is for wrong units, which are 100 times off or more.
constexpr double kUnlikely = 50.0;

/// Mean volume of spheres whose diameters are uniform over a range [m^3]: the mean of d^3 is
/// (a^3 + a^2 b + a b^2 + b^3) / 4.
double mean_volume(const Range& diameter) {
  const double a = diameter.low, b = diameter.high;
  return kPi / 6.0 * (a + b) * (a * a + b * b) / 4.0;
}

/// Mean of volumes with N(>= V) proportional to V^-b between two bounds [m^3].
double mean_volume(const VolumePowerLaw& law) {
  const double b = law.exponent, span = std::log(law.volume.high / law.volume.low);
  if (!(span > 0.0)) return law.volume.low;
  const double sum = b == 1.0 ? span : std::expm1((1.0 - b) * span) / (1.0 - b);
  return b * law.volume.low * sum / -std::expm1(-b * span);
}

/// By class of blocks: its share of the blocks times its mean volume [m^3].
std::vector<double> class_volumes(const Scenario& s) {
  if (s.blocks.classes.empty()) return {mean_volume(s.blocks.power_law)};
  double weights = 0.0;
  for (const BlockClass& block : s.blocks.classes) weights += block.weight;
  std::vector<double> volumes;
  for (const BlockClass& block : s.blocks.classes)
    volumes.push_back(block.weight / weights * mean_volume(block.diameter));
  return volumes;
}

/// Surface of the cells that polygons release, each counted once [m^2].
double area_of_polygons(const Scenario& s) {
  const Grid& grid = s.surface.grid();
  std::vector<std::pair<int, int>> cells;  // row, column
  for (const SourceCell& cell : s.sources)
    if (!cell.point && s.features[cell.feature].has_area)
      cells.emplace_back(grid.row_of(cell.y), grid.column_of(cell.x));
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  double area = 0.0;
  for (const auto& [row, column] : cells) area += true_area(s.surface.heights(), column, row);
  return area;
}

}  // namespace

std::optional<AnnualRock> annual_rock(const Scenario& s) {
  const std::optional<AnnualWeights> weights = AnnualWeights::of(s);
  if (!weights) return std::nullopt;
  const std::vector<double> volumes = class_volumes(s);
  AnnualRock rock;
  rock.events = weights->scale().total;
  for (std::uint32_t source = 0; source < s.sources.size(); ++source) {
    const SourceFeature& feature = s.features[s.sources[source].feature];
    const auto events = [&](std::size_t block_class) {  // if all blocks were of this class [1/year]
      return weights->of_class(source, block_class) * s.trajectories;
    };
    double volume = 0.0;
    if (!std::isnan(feature.diameter.low))
      volume = events(0) * mean_volume(feature.diameter);
    else
      for (std::size_t i = 0; i < volumes.size(); ++i) volume += events(i) * volumes[i];
    rock.volume += volume;
    if (!s.sources[source].point && feature.has_area) rock.from_area += volume;
  }
  rock.area = area_of_polygons(s);
  return rock;
}

std::string retreat_text(double metres_per_year) {
  return metres_per_year < 1.0 ? with_digits(1e3 * metres_per_year, metres_per_year < 0.1 ? 2 : 3) + " mm a year"
                               : readable(metres_per_year) + " m a year";
}

std::string retreat_warning(const Scenario& scenario) {
  const std::optional<AnnualRock> rock = annual_rock(scenario);
  if (!rock || !(rock->retreat() > kUnlikely * kMuchRetreat)) return {};
  return kRetreatWarning + readable(rock->from_area) + " m3 of rock a year fall from polygons of " +
         readable(rock->area) + " m2 of surface, which would go back by " + retreat_text(rock->retreat()) + "; " +
         retreat_text(kMuchRetreat) +
         " is much in the Alps: check the unit of the frequencies (events per year; per_area: per m2, not per "
         "hectare) and the diameters";
}

}  // namespace talus
