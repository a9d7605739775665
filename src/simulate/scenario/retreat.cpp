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

bool is_of_polygon(const Scenario& s, const SourceCell& cell) {
  return !cell.point && s.features[cell.feature].has_area;
}

/// Surface of the cells that polygons release, each counted once [m^2].
double area_of_polygons(const Scenario& s) {
  const Grid& grid = s.surface.grid();
  std::vector<std::pair<int, int>> cells;  // row, column
  for (const SourceCell& cell : s.sources)
    if (is_of_polygon(s, cell)) cells.emplace_back(grid.row_of(cell.y), grid.column_of(cell.x));
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  double area = 0.0;
  for (const auto& [row, column] : cells) area += true_area(s.surface.heights(), column, row);
  return area;
}

/// By source cell: rock that falls from it [m^3/year].
std::vector<double> annual_volumes(const Scenario& s, const AnnualWeights& weights) {
  const std::vector<double> of_class = class_volumes(s);
  std::vector<double> volumes(s.sources.size());
  for (std::uint32_t source = 0; source < volumes.size(); ++source) {
    const Range& own = s.features[s.sources[source].feature].diameter;
    const auto events = [&](std::size_t block_class) {  // if all blocks were of this class [1/year]
      return weights.of_class(source, block_class) * s.trajectories;
    };
    if (!std::isnan(own.low))
      volumes[source] = events(0) * mean_volume(own);
    else
      for (std::size_t i = 0; i < of_class.size(); ++i) volumes[source] += events(i) * of_class[i];
  }
  return volumes;
}

/// The polygon whose rock face goes back fastest; nothing without polygons.
struct FastestRetreat {
  std::size_t feature = 0;
  double volume = 0.0, area = 0.0;  ///< as AnnualRock::from_area and area, of this feature alone
};

std::optional<FastestRetreat> fastest_retreat(const Scenario& s, const AnnualWeights& weights) {
  const std::vector<double> volumes = annual_volumes(s, weights);
  const Grid& grid = s.surface.grid();
  std::vector<FastestRetreat> of(s.features.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const SourceCell& cell = s.sources[i];
    if (!is_of_polygon(s, cell)) continue;
    of[cell.feature].feature = cell.feature;
    of[cell.feature].volume += volumes[i];
    of[cell.feature].area += true_area(s.surface.heights(), grid.column_of(cell.x), grid.row_of(cell.y));
  }
  std::erase_if(of, [](const FastestRetreat& r) { return !(r.area > 0.0); });
  if (of.empty()) return std::nullopt;
  return *std::ranges::max_element(of, {}, [](const FastestRetreat& r) { return r.volume / r.area; });
}

}  // namespace

std::optional<AnnualRock> annual_rock(const Scenario& s) {
  const std::optional<AnnualWeights> weights = AnnualWeights::of(s);
  if (!weights) return std::nullopt;
  const std::vector<double> volumes = annual_volumes(s, *weights);
  AnnualRock rock;
  rock.events = weights->scale().total;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    rock.volume += volumes[i];
    if (is_of_polygon(s, s.sources[i])) rock.from_area += volumes[i];
  }
  rock.area = area_of_polygons(s);
  return rock;
}

std::string retreat_text(double metres_per_year) {
  return metres_per_year < 1.0 ? with_digits(1e3 * metres_per_year, metres_per_year < 0.1 ? 2 : 3) + " mm a year"
                               : readable(metres_per_year) + " m a year";
}

std::string retreat_warning(const Scenario& scenario) {
  const std::optional<AnnualWeights> weights = AnnualWeights::of(scenario);
  if (!weights) return {};
  const auto fastest = fastest_retreat(scenario, *weights);
  if (!fastest || !(fastest->volume > kUnlikely * kMuchRetreat * fastest->area)) return {};
  const std::string& name = scenario.features[fastest->feature].name;
  const std::string which = scenario.features.size() == 1 ? "" : name.empty() ? "a feature, " : "'" + name + "', ";
  return kRetreatWarning + readable(fastest->volume) + " m3 of rock a year fall from " + which + "a polygon of " +
         readable(fastest->area) + " m2 of surface, which would go back by " +
         retreat_text(fastest->volume / fastest->area) + "; " + retreat_text(kMuchRetreat) +
         " is much in the Alps: check the unit of the frequencies (events per year; per_area: per m2, not per "
         "hectare) and the diameters";
}

}  // namespace talus
