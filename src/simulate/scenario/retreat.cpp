#include "talus/simulate/scenario/retreat.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "talus/base/text.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus {
namespace {

constexpr double kMostRetreat = 0.1;  // 50 times what is much in the Alps [m/year]

/// Mean volume of spheres whose diameters are uniform over a range [m^3]: the mean of d^3 is
/// (a^3 + a^2 b + a b^2 + b^3) / 4.
double mean_volume(const Range& diameter) {
  const double a = diameter.low, b = diameter.high;
  return kPi / 6.0 * (a + b) * (a * a + b * b) / 4.0;
}

/// Mean of volumes with N(>= V) proportional to V^-b between two bounds [m^3].
double mean_volume(const VolumePowerLaw& law) {
  const double b = law.exponent, low = law.volume.low, high = law.volume.high;
  if (!(low < high)) return low;
  const double sum =
      b == 1.0 ? std::log(high / low) : b * (std::pow(high, 1.0 - b) - std::pow(low, 1.0 - b)) / (1.0 - b);
  return sum / (std::pow(low, -b) - std::pow(high, -b));
}

/// Rock that one event of each class brings, times the share of blocks drawn from it [m^3].
std::vector<double> class_volumes(const Scenario& s) {
  if (s.blocks.classes.empty()) return {mean_volume(s.blocks.power_law)};
  double weights = 0.0;
  for (const BlockClass& block : s.blocks.classes) weights += block.weight;
  std::vector<double> volumes;
  for (const BlockClass& block : s.blocks.classes)
    volumes.push_back(block.weight / weights * mean_volume(block.diameter));
  return volumes;
}

}  // namespace

std::optional<AnnualRock> annual_rock(const Scenario& s) {
  const std::optional<AnnualWeights> weights = AnnualWeights::of(s);
  if (!weights) return std::nullopt;
  const Grid& grid = s.surface.grid();
  const std::vector<double> volumes = class_volumes(s);
  AnnualRock rock;
  rock.events = weights->scale().total;
  for (std::uint32_t source = 0; source < s.sources.size(); ++source) {
    const SourceCell& cell = s.sources[source];
    const Range& own = s.features[cell.feature].diameter;
    const auto blocks = [&](std::size_t block_class) {  // of a class that is alone [1/year]
      return weights->of_class(source, block_class) * s.trajectories;
    };
    if (!std::isnan(own.low))
      rock.volume += blocks(0) * mean_volume(own);
    else
      for (std::size_t i = 0; i < volumes.size(); ++i) rock.volume += blocks(i) * volumes[i];
    rock.area += true_area(s.surface.heights(), grid.column_of(cell.x), grid.row_of(cell.y));
  }
  if (std::ranges::any_of(s.sources, &SourceCell::point)) rock.area = 0.0;
  return rock;
}

std::string retreat_warning(const Scenario& scenario) {
  const std::optional<AnnualRock> rock = annual_rock(scenario);
  if (!rock || !(rock->retreat() > kMostRetreat)) return {};
  return kRetreatWarning + with_digits(rock->events, 3) + " events per year bring " + with_digits(rock->volume, 3) +
         " m3 of rock from sources of " + with_digits(rock->area, 3) + " m2, which would go back by " +
         with_digits(rock->retreat(), 2) +
         " m a year (2 mm are much in the Alps): are they meant per year, and for this area?";
}

}  // namespace talus
