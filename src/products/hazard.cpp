#include "talus/products/hazard.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>

#include "in_double.hpp"
#include "talus/base/expect.hpp"
#include "talus/products/interval.hpp"

namespace talus {
namespace {

constexpr float kLargestOfCurves = 0x1p17F;  // [kJ]: 100 t at 50 m/s
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Upper Poisson bound of a count k, less k: 3.69 at 0. For any k >= 0, not only whole numbers.
double poisson_margin(double k) {
  return boost::math::gamma_p_inv(k + 1.0, 1.0 - kTail, InDouble()) - k;
}

}  // namespace

Bounded gamma_interval(double sum, double squares, double largest) {
  const double above = sum + largest, spread = squares + largest * largest;
  return {sum, sum > 0.0 ? boost::math::gamma_p_inv(sum * sum / squares, kTail, InDouble()) * squares / sum : 0.0,
          boost::math::gamma_p_inv(above * above / spread, 1.0 - kTail, InDouble()) * spread / above};
}

Bounded annual_frequency(const WeightSums& counted, const WeightScale& scale) {
  const double sum = std::min(counted.sum, scale.total), w = scale.largest_weight();
  const double squares = std::min(counted.squares, sum * w);  // small weights are rounded up when they are squared
  Bounded bounds = gamma_interval(sum, squares, w);
  const double margin = w * poisson_margin(std::max(0.0, squares - counted.overlap) / (w * w));
  bounds.low = std::max(bounds.low, sum > 0.0 ? sum - margin : 0.0);
  bounds.high = std::min({bounds.high, sum + margin, scale.total});
  if (scale.equal) {
    const auto hits = std::min(scale.trajectories, static_cast<std::uint64_t>(std::llround(counted.sum / w)));
    const Interval exact = probability_bounds(hits, scale.trajectories, kConfidence);
    bounds.low = std::max(bounds.low, scale.total * exact.low);
    bounds.high = std::min(bounds.high, scale.total * exact.high);
  }
  bounds.low = std::min(bounds.low, sum);
  bounds.high = std::max(bounds.high, sum);
  TALUS_EXPECT(bounds.low >= 0.0, "a frequency is not below 0");
  return bounds;
}

Bounded return_period(const Bounded& frequency) {
  return {1.0 / frequency.value, 1.0 / frequency.high, 1.0 / frequency.low};
}

std::vector<CurveEnergy> curve_energies(const EnergyBins& bins) {
  std::vector<CurveEnergy> energies{{0.0, 0}};
  for (float energy = 1.0F; energy <= kLargestOfCurves; energy *= 2.0F) energies.push_back({energy, bins.of(energy)});
  for (std::size_t i = 0; i < bins.thresholds().size(); ++i) energies.push_back({bins.thresholds()[i], bins.above(i)});
  std::ranges::sort(energies, {}, &CurveEnergy::energy);
  const auto same_energy = [](const CurveEnergy& a, const CurveEnergy& b) { return a.energy == b.energy; };
  energies.erase(std::unique(energies.begin(), energies.end(), same_energy), energies.end());
  return energies;
}

HazardCurve::HazardCurve(const HazardRules& rules, const HazardCell& cell)
    : rules_(rules), first_(cell.first()), sums_(cell.bins().size() + 1), levels_(rules.levels()) {
  const double unit = rules.scale.unit, square_unit = rules.scale.square_unit;
  std::int64_t sum = 0, squares = 0;
  const auto bins = cell.bins();
  for (std::size_t i = bins.size(); i-- > 0;) {
    sum += bins[i].weight;
    squares += bins[i].square;
    sums_[i] = {static_cast<double>(sum) * unit, static_cast<double>(squares) * square_unit, 0.0};
  }
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const int bin = level == 0 ? first_ : std::max(first_, rules.bins.above(level - 1));
    levels_[level] = sums_[std::min(static_cast<std::size_t>(bin - first_), bins.size())];
    if (level < cell.overlaps().size())
      levels_[level].overlap = static_cast<double>(cell.overlaps()[level]) * square_unit;
  }
}

Bounded HazardCurve::passage() const {
  return annual_frequency(levels_[0], rules_.scale);
}

Bounded HazardCurve::exceedance(std::size_t threshold) const {
  return annual_frequency(levels_[threshold + 1], rules_.scale);
}

double HazardCurve::side(std::size_t i, Side which) const {
  if (which == Side::Value) return std::min(sums_[i].sum, rules_.scale.total);
  const Bounded bounds = at(i);
  return which == Side::Low ? bounds.low : bounds.high;
}

Bounded HazardCurve::exceedance_of(double energy) const {
  if (const auto threshold = rules_.bins.threshold_at(energy)) return exceedance(*threshold);
  const std::size_t last = sums_.size() - 1;
  std::size_t i = 0;
  while (i < last && rules_.bins.edge(first_ + static_cast<int>(i) + 1) <= energy) ++i;
  const Bounded below = at(i);
  const double low = rules_.bins.edge(first_ + static_cast<int>(i));
  if (i == last || !(energy > low)) return below;
  const double share = std::log(energy / low) / std::log(rules_.bins.edge(first_ + static_cast<int>(i) + 1) / low);
  const Bounded above = at(i + 1);
  const auto between = [share](double a, double b) { return a + (b - a) * share; };
  return {between(below.value, above.value), between(below.low, above.low), between(below.high, above.high)};
}

double HazardCurve::frequency_from(int bin) const {
  const auto i = static_cast<std::size_t>(std::max(0, bin - first_));
  return side(std::min(i, sums_.size() - 1), Side::Value);
}

/// The curve falls with the energy. Bisection finds the last edge where it is at least `frequency`; the energy is then
/// interpolated in the bin above that edge.
double HazardCurve::energy_of(double frequency, Side which) const {
  const std::size_t last = sums_.size() - 1;
  if (side(0, which) < frequency) return 0.0;
  if (side(last, which) >= frequency) return kInfinity;
  std::size_t low = 0, high = last;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (side(middle, which) >= frequency ? low : high) = middle;
  }
  const double from = rules_.bins.edge(first_ + static_cast<int>(low)),
               to = rules_.bins.edge(first_ + static_cast<int>(high));
  const double above = side(low, which), below = side(high, which);
  return from * std::pow(to / from, (above - frequency) / (above - below));
}

Bounded HazardCurve::energy_once_in(double years) const {
  const double once = kOnce / years;
  return {energy_of(once, Side::Value), energy_of(once, Side::Low), energy_of(once, Side::High)};
}

}  // namespace talus
