#include "talus/simulate/scenario/retreat.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "talus/base/text.hpp"
#include "talus/simulate/scenario/block_class.hpp"
#include "talus/simulate/scenario/frequency.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus {
namespace {

/// Multiple of `kMuchRetreat` above which the warning comes: it is for wrong units, which are 100 times off or more.
constexpr double kUnlikely = 50.0;

/// Events per year above which a polygon releases more than one block a year, whatever the rounding of the weights.
constexpr double kSeveral = 1.01;

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

/// By class of blocks: its share of the blocks.
std::vector<double> class_shares(const Scenario& s) {
  if (s.blocks.classes.empty()) return {1.0};
  const double weights = total_weight(s.blocks.classes);
  std::vector<double> shares;
  for (const BlockClass& block : s.blocks.classes) shares.push_back(block.weight / weights);
  return shares;
}

/// By class of blocks: its mean volume [m^3].
std::vector<double> class_volumes(const Scenario& s) {
  if (s.blocks.classes.empty()) return {mean_volume(s.blocks.power_law)};
  std::vector<double> volumes;
  for (const BlockClass& block : s.blocks.classes) volumes.push_back(mean_volume(block.diameter));
  return volumes;
}

/// Whether a place of release is a cell of a feature that is drawn as polygons.
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

/// Events and rock of a source cell, or of a whole feature, in a year.
struct Fall {
  double events = 0.0, volume = 0.0;  // [1/year], [m^3/year]
  void add(const Fall& other) { events += other.events, volume += other.volume; }
};

/// By source cell.
std::vector<Fall> annual_falls(const Scenario& s, const AnnualWeights& weights) {
  const std::vector<double> shares = class_shares(s), volumes = class_volumes(s);
  std::vector<Fall> falls(s.sources.size());
  for (std::uint32_t source = 0; source < falls.size(); ++source) {
    const Range& own = s.features[s.sources[source].feature].diameter;
    const auto events = [&](std::size_t block_class) {  // if all blocks were of this class [1/year]
      return weights.of_class(source, block_class) * s.trajectories;
    };
    if (!std::isnan(own.low))
      falls[source] = {events(0), events(0) * mean_volume(own)};
    else
      for (std::size_t i = 0; i < volumes.size(); ++i)
        falls[source].add({events(i) * shares[i], events(i) * shares[i] * volumes[i]});
  }
  return falls;
}

/// A polygon, or several together, whose rock face goes back.
struct RockFace {
  std::string name;
  Fall fall;
  double area = 0.0;  // of the surface of its cells [m^2]
  double retreat() const { return fall.volume / area; }
};

/// By feature; only those of polygons.
std::vector<RockFace> rock_faces(const Scenario& s, const std::vector<Fall>& falls) {
  const Grid& grid = s.surface.grid();
  std::vector<RockFace> faces(s.features.size());
  for (std::size_t i = 0; i < falls.size(); ++i) {
    const SourceCell& cell = s.sources[i];
    if (!is_of_polygon(s, cell)) continue;
    RockFace& face = faces[cell.feature];
    face.name = s.features[cell.feature].name;
    face.fall.add(falls[i]);
    face.area += true_area(s.surface.heights(), grid.column_of(cell.x), grid.row_of(cell.y));
  }
  std::erase_if(faces, [](const RockFace& face) { return !(face.area > 0.0); });
  return faces;
}

}  // namespace

std::optional<AnnualRock> annual_rock(const Scenario& s) {
  const std::optional<AnnualWeights> weights = AnnualWeights::of(s);
  if (!weights) return std::nullopt;
  const std::vector<Fall> falls = annual_falls(s, *weights);
  AnnualRock rock;
  rock.events = weights->scale().total;
  for (std::size_t i = 0; i < falls.size(); ++i) {
    rock.volume += falls[i].volume;
    if (is_of_polygon(s, s.sources[i])) rock.from_area += falls[i].volume;
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
  const std::vector<RockFace> faces = rock_faces(scenario, annual_falls(scenario, *weights));
  RockFace worst;  // all together, or the one of several blocks a year that goes back fastest
  for (const RockFace& face : faces) worst.fall.add(face.fall);
  worst.area = area_of_polygons(scenario);
  for (const RockFace& face : faces)
    if (face.fall.events > kSeveral && face.retreat() > worst.retreat()) worst = face;
  if (!(worst.retreat() > kUnlikely * kMuchRetreat)) return {};
  const std::string where = worst.name.empty()
                                ? "the polygons, " + readable(worst.area) + " m2 of surface, which"
                                : "the polygon '" + worst.name + "', " + readable(worst.area) + " m2 of surface, which";
  return kRetreatWarning + readable(worst.fall.volume) + " m3 of rock a year fall from " + where +
         " would go back by " + retreat_text(worst.retreat()) + "; " + retreat_text(kMuchRetreat) +
         " is much in the Alps: check the unit of the frequencies (events per year; per_area: per m2, not per "
         "hectare) and the diameters";
}

}  // namespace talus
