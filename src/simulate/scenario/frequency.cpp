#include "talus/simulate/scenario/frequency.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "talus/base/error.hpp"
#include "talus/base/expect.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/block_class.hpp"
#include "talus/simulate/scenario/block_sizes.hpp"
#include "talus/simulate/scenario/doubled_points.hpp"
#include "talus/simulate/scenario/retreat.hpp"
#include "talus/terrain/source_slope.hpp"

namespace talus {
namespace {

constexpr int kBits = 62;                    // of the sum over all trajectories of all rounds
constexpr double kLargestFactor = 1e9;       // events of a block of a class over those of a block of equal shares
constexpr std::int64_t kLeastWeight = 1024;  // below it the unit would change a weight by more than 0.05 %
constexpr std::string_view kOverlapWarning = "sources overlap: ", kAreaWarning = "areas of sources: ";

/// The inputs that give frequencies.
struct Sources {
  bool features = false, classes = false, total = false, area = false, law = false;
  int count() const { return int{features} + int{classes} + int{total} + int{area} + int{law}; }
};

[[noreturn]] void refuse(const std::string& what) {
  throw InputError("frequency: " + what);
}

std::string feature_name(const Scenario& s, std::size_t i) {
  return "feature " + (s.features[i].name.empty() ? "number " + std::to_string(i) + " (from 0)" : s.features[i].name);
}

Sources sources_of(const Scenario& s) {
  const FrequencyRules& rules = s.frequency;
  Sources found;
  for (const SourceFeature& f : s.features) found.features = found.features || f.frequency > 0.0;  // zeros: not given
  for (const BlockClass& c : s.blocks.classes)
    found.classes = found.classes || (!rules.class_shares && !std::isnan(c.frequency));
  found.total = !std::isnan(rules.total);
  found.area = !std::isnan(rules.per_area);
  found.law = !std::isnan(rules.scale);
  return found;
}

void check_contradictions(const Scenario& s, const Sources& found) {
  if (found.count() > 1)
    refuse(
        std::string("is given by ") + (found.features ? "the field frequency of the sources, " : "") +
        (found.classes ? "the classes of blocks.diameter, " : "") +
        (found.total ? "frequency.total (--frequency), " : "") + (found.area ? "frequency.per_area, " : "") +
        (found.law ? "frequency.power_law, " : "") + "must be given by one of them: leave out the others" +
        (found.features ? " (--field frequency= leaves out the field)" : "") +
        (found.features && found.classes
             ? "; for the frequency of each source with shares of sizes give the classes weight in place of frequency"
             : ""));
  if (found.features)
    for (const SourceCell& cell : s.sources)
      if (std::isnan(s.features[cell.feature].frequency))
        refuse(
            feature_name(s, cell.feature) +
            " of the sources has no frequency, but others have; must be given for all (0 where nothing falls) or none");
  if (found.count() == 0 && s.frequency.by_true_area)
    refuse(
        "by_true_area = true, but nothing says how often blocks fall; give the sources a field frequency, or "
        "frequency.total, frequency.per_area or frequency.power_law");
  if (found.classes || found.law || s.frequency.class_shares)
    for (const SourceCell& cell : s.sources)
      if (!std::isnan(s.features[cell.feature].diameter.low))
        refuse(feature_name(s, cell.feature) +
               " of the sources has a diameter of its own, where a frequency by size "
               "of the blocks does not hold; give the sources a field frequency instead");
  const bool areas = found.area || s.frequency.by_true_area;
  if (areas && std::ranges::any_of(s.sources, [](const SourceCell& cell) { return cell.point; }))
    refuse(
        "a source is a point, which has no area; give the sources a field frequency and leave out per_area and "
        "by_true_area, or draw polygons");
  if (found.area)
    for (const SourceCell& cell : s.sources)
      if (!s.features[cell.feature].has_area)
        refuse(
            feature_name(s, cell.feature) +
            " of the sources is not of polygons alone, so that frequency.per_area would count the area of cells that "
            "a line crosses; give the sources a field frequency instead, or draw polygons");
}

/// Events per year of volumes between two bounds, N(>= V) = A V^-b.
double frequency_between(const FrequencyRules& rules, double low, double high) {
  return rules.scale * (std::pow(low, -rules.exponent) - std::pow(high, -rules.exponent));
}

double volume_of(double diameter) {
  return kPi / 6.0 * diameter * diameter * diameter;
}

/// Events per year of each class of blocks, by the power law N(>= V) = A V^-b; one number for blocks drawn by a law.
std::vector<double> law_frequencies(const Scenario& s) {
  const FrequencyRules& rules = s.frequency;
  const VolumePowerLaw& law = s.blocks.power_law;
  if (law.volume.high > 0.0) {
    if (law.exponent != rules.exponent)
      refuse("power_law.b = " + text_of(rules.exponent) + ", must be the exponent of blocks.diameter, " +
             text_of(law.exponent) + ": the blocks are drawn by that one");
    if (!(law.volume.low < law.volume.high))
      refuse("power_law with volume_min = volume_max, must be a range of volumes");
    return {frequency_between(rules, law.volume.low, law.volume.high)};
  }
  std::vector<Range> volumes;
  std::vector<double> frequencies;
  for (const BlockClass& c : s.blocks.classes) {
    volumes.push_back({volume_of(c.diameter.low), volume_of(c.diameter.high)});
    if (!(c.diameter.low < c.diameter.high))
      refuse("power_law with blocks of one diameter, " + text_of(c.diameter.low) +
             " m; blocks.diameter must be a power law of volume, or ranges of diameters");
    frequencies.push_back(frequency_between(rules, volumes.back().low, volumes.back().high));
  }
  std::ranges::sort(volumes, {}, &Range::low);
  constexpr double kNoGap = 1.01;  // limits that were rounded
  for (std::size_t i = 1; i < volumes.size(); ++i) {
    if (volumes[i].low < volumes[i - 1].high * (1.0 - 1e-12))
      refuse("power_law with classes of blocks that overlap, must lie side by side");
    if (volumes[i].low > volumes[i - 1].high * kNoGap)
      refuse("power_law with a gap between classes of blocks, from " + readable(diameter_of(volumes[i - 1].high)) +
             " to " + readable(diameter_of(volumes[i].low)) + " m, must lie side by side: " +
             with_digits(frequency_between(rules, volumes[i - 1].high, volumes[i].low), 3) +
             " events per year of these sizes would be lost");
  }
  return frequencies;
}

/// Area of a source cell, in plan or of its surface [m^2]. Frequencies are divided in proportion to it.
double area_of(const Scenario& s, const SourceCell& cell) {
  const Grid& grid = s.surface.grid();
  if (!s.frequency.by_true_area) return grid.cell_x * grid.cell_y;
  return true_area(s.surface.heights(), grid.column_of(cell.x), grid.row_of(cell.y));
}

/// Events per year of each source cell, all classes together.
std::vector<double> cell_frequencies(const Scenario& s, const Sources& found, double all_classes) {
  std::vector<double> cells;
  cells.reserve(s.sources.size());
  for (const SourceCell& cell : s.sources) cells.push_back(area_of(s, cell));
  if (found.area) {
    for (double& cell : cells) cell *= s.frequency.per_area;
  } else if (found.features) {
    std::vector<double> sums(s.features.size());
    for (std::size_t i = 0; i < cells.size(); ++i) sums[s.sources[i].feature] += cells[i];
    for (std::size_t i = 0; i < cells.size(); ++i)
      cells[i] *= s.features[s.sources[i].feature].frequency / sums[s.sources[i].feature];
  } else {
    const double sum = std::accumulate(cells.begin(), cells.end(), 0.0);
    for (double& cell : cells) cell *= all_classes / sum;
  }
  return cells;
}

/// Frequency of a block of each class relative to the mean: share of the events over share of the blocks.
std::vector<double> class_factors(const Scenario& s, const std::vector<double>& frequencies) {
  const auto& classes = s.blocks.classes;
  if (frequencies.size() < 2) return {1.0};
  const double weights = total_weight(classes);
  const double events = std::accumulate(frequencies.begin(), frequencies.end(), 0.0);
  std::vector<double> factors;
  for (std::size_t c = 0; c < classes.size(); ++c)
    factors.push_back(events > 0.0 ? frequencies[c] / events * weights / classes[c].weight : 0.0);
  return factors;
}

/// Refuses the class whose blocks would stand for most events each.
[[noreturn]] void refuse_light_class(const Scenario& s, const std::vector<double>& frequencies,
                                     const std::vector<double>& factors) {
  constexpr double kComfortable = 1e3;  // times the events of a block of equal shares
  const auto c = static_cast<std::size_t>(std::ranges::max_element(factors) - factors.begin());
  const BlockClass& light = s.blocks.classes[c];
  const double events = std::accumulate(frequencies.begin(), frequencies.end(), 0.0);
  refuse("the class of " + metres(light.diameter) + " has the weight " + text_of(light.weight) +
         ", far too small for its " + percent(frequencies[c] / events) + " of the events: give it " +
         with_digits(light.weight * factors[c] / kComfortable, 2) +
         " or more: a weight says only how many blocks are drawn");
}

double power_of_two_above(double value) {
  return std::ldexp(1.0, std::ilogb(value) + 1);
}

/// The source cells in the order of their places; without points, of which a cell may have several.
std::vector<const SourceCell*> cells_by_place(const Scenario& s) {
  std::vector<const SourceCell*> cells;
  for (const SourceCell& cell : s.sources)
    if (!cell.point) cells.push_back(&cell);
  std::ranges::sort(cells, {}, [](const SourceCell* cell) { return std::pair(cell->y, cell->x); });
  return cells;
}

/// One line if several features release the same cells; empty if not.
std::string overlap_warning(const Scenario& s) {
  constexpr double kNoticed = 0.01;  // of the cells: two lines that meet share one
  const Sources found = sources_of(s);
  if (s.features.size() < 2) return {};
  const std::vector<const SourceCell*> cells = cells_by_place(s);
  const auto same = [&](std::size_t i) { return cells[i]->x == cells[i - 1]->x && cells[i]->y == cells[i - 1]->y; };
  std::uint64_t places = cells.empty() ? 0 : 1, shared = 0;
  double again = 0.0;  // area that counts once more [m^2]
  for (std::size_t i = 1; i < cells.size(); ++i) {
    if (!same(i)) {
      ++places;
      continue;
    }
    shared += i > 1 && same(i - 1) ? 0U : 1U;
    again += area_of(s, *cells[i]);
  }
  if (shared == 0 || static_cast<double>(shared) < kNoticed * static_cast<double>(places)) return {};
  return std::string(kOverlapWarning) + std::to_string(shared) + " of " + std::to_string(places) +
         " cells lie in more than one feature and release the blocks of each" +
         (found.area ? ", so that frequency.per_area counts " + with_digits(s.frequency.per_area * again, 3) +
                           " events per year more than once"
          : found.features    ? ", so that the events per year of each count there"
          : found.count() > 0 ? ", so that they get a larger share of the events"
                              : "") +
         ": join the features or cut one out of the other, unless each is meant to release its own blocks there";
}

/// One line for features whose cells cover twice or half the area of their polygons, where events are counted by area:
/// polygons narrower than a few cells; empty if there are none.
std::string area_warning(const Scenario& s) {
  constexpr double kNoticed = 2.0;
  if (std::isnan(s.frequency.per_area)) return {};
  std::vector<double> covered(s.features.size());  // by feature [m^2]
  for (const SourceCell& cell : s.sources) covered[cell.feature] += s.surface.grid().cell_x * s.surface.grid().cell_y;
  std::vector<std::string> odd;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const double drawn = s.features[i].drawn_area;
    if (covered[i] > 0.0 && (covered[i] > kNoticed * drawn || drawn > kNoticed * covered[i]))
      odd.push_back(feature_name(s, i) + " (" + readable(covered[i]) + " instead of " + readable(drawn) + " m2)");
  }
  if (odd.empty()) return {};
  return std::string(kAreaWarning) +
         "per_area counts the area of the cells that release blocks, which is far from that of the polygons: " +
         listed(odd) + "; give each feature a field frequency, or take a finer DEM";
}

}  // namespace

std::vector<double> class_frequencies(const Scenario& s) {
  const Sources found = sources_of(s);
  if (found.law) return law_frequencies(s);
  std::vector<double> frequencies;
  if (found.classes || s.frequency.class_shares)
    for (const BlockClass& c : s.blocks.classes) frequencies.push_back(c.frequency);
  return frequencies;
}

std::vector<std::string> frequency_warnings(const Scenario& s) {
  std::vector<std::string> warnings{rare_class_warning(s), overlap_warning(s), doubled_points_warning(s),
                                    area_warning(s), retreat_warning(s)};
  std::erase(warnings, "");
  return warnings;
}

bool is_of_frequencies(const std::string& warning) {
  return warning.starts_with(kOverlapWarning) || warning.starts_with(kAreaWarning) ||
         warning.starts_with(kDoubledPoints) || warning.starts_with(kRetreatWarning) ||
         warning.find(kRareClasses) != std::string::npos;
}

std::optional<AnnualWeights> AnnualWeights::of(const Scenario& s, std::uint32_t rounds) {
  TALUS_EXPECT(rounds >= 1, "there is one round at least");
  const int room_bits = std::bit_width(rounds - 1), bits = kBits - room_bits;  // of the rounds, of the sum over one
  const Sources found = sources_of(s);
  check_contradictions(s, found);
  if (found.count() == 0) return std::nullopt;
  const std::vector<double> by_class = class_frequencies(s);
  const double events = found.total ? s.frequency.total : std::accumulate(by_class.begin(), by_class.end(), 0.0);
  const std::vector<double> cells = cell_frequencies(s, found, events), factors = class_factors(s, by_class);
  const double largest_factor = *std::ranges::max_element(factors);
  if (largest_factor > kLargestFactor) refuse_light_class(s, by_class, factors);

  AnnualWeights out;
  WeightScale& scale = out.scale_;
  out.classes_ = factors.size();
  scale.trajectories = s.released();
  scale.largest_diameter = diameters_of(s).high;
  scale.room = std::ldexp(1.0, room_bits);
  double most = 0.0, squares = 0.0;  // bounds of the sums over all trajectories
  for (const double cell : cells) {
    const double weight = cell * largest_factor / s.trajectories;
    most += weight * s.trajectories;
    squares += weight * weight * s.trajectories;
    scale.total += cell;
  }
  if (!(scale.total > 0.0) && !found.total) return std::nullopt;        // a field of zeros counts as not given
  if (squares < std::ldexp(std::numeric_limits<double>::min(), kBits))  // its unit would be 0
    refuse("all sources together have " + text_of(std::max(scale.total, s.frequency.total)) +
           " events per year, must be 1e-100 at least");
  scale.unit = std::ldexp(power_of_two_above(most), -bits);
  scale.square_unit = std::ldexp(power_of_two_above(squares), -bits);
  out.weights_.reserve(cells.size() * factors.size());
  for (const double cell : cells)
    for (const double factor : factors) {
      const double weight = cell * factor / s.trajectories;
      out.weights_.push_back(static_cast<std::int64_t>(weight / scale.unit + 0.5));
      if (weight > 0.0 && out.weights_.back() < kLeastWeight && largest_factor > 1e6)
        refuse_light_class(s, by_class, factors);
      if (weight > 0.0 && out.weights_.back() < kLeastWeight)
        refuse("a trajectory stands for " + text_of(weight) + " events per year, too few beside all " +
               text_of(scale.total) + "; give 0 instead");
    }
  scale.largest = *std::ranges::max_element(out.weights_);
  scale.equal = *std::ranges::min_element(out.weights_) == scale.largest;
  return out;
}

std::int64_t AnnualWeights::weight(const Scenario& scenario, std::uint32_t source, std::uint32_t block) const {
  return weights_[source * classes_ + (classes_ > 1 ? class_of_block(scenario, source, block) : 0)];
}

double AnnualWeights::of_class(std::uint32_t source, std::size_t block_class) const {
  return static_cast<double>(weights_[source * classes_ + std::min(block_class, classes_ - 1)]) * scale_.unit;
}

}  // namespace talus
