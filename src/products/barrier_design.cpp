#include "talus/products/barrier_design.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/sample.hpp"
#include "talus/base/vector.hpp"

namespace talus {
namespace {

std::vector<double> sorted(std::span<const double> values) {
  std::vector<double> copy(values.begin(), values.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

double share_within(const std::vector<double>& places, double from, double to) {
  const auto inside =
      std::upper_bound(places.begin(), places.end(), to) - std::lower_bound(places.begin(), places.end(), from);
  return static_cast<double>(inside) / static_cast<double>(places.size());
}

}  // namespace

BarrierDesign design_barrier(std::span<const double> speeds, std::span<const double> heights, const DesignBlock& block,
                             const DesignFactors& factors) {
  BarrierDesign d{};
  const double reach = factors.trajectory * factors.topography;
  d.speed_percentile = quantile(sorted(speeds), factors.percentile);
  d.height_percentile = quantile(sorted(heights), factors.percentile);
  d.speed = d.speed_percentile * reach;
  d.mass = block.volume * block.density * factors.volume * factors.density;
  d.energy = 0.5 * d.mass * d.speed * d.speed;
  d.sel = factors.sel * d.energy;
  d.mel = factors.mel * d.energy;
  d.freeboard = std::max(factors.freeboard, 0.5 * std::cbrt(6.0 * block.volume / kPi));
  d.height = d.height_percentile * reach + d.freeboard;
  return d;
}

std::size_t fewest_for_percentile(double percentile) {
  return static_cast<std::size_t>(std::ceil(1.0 / (1.0 - percentile) - 1e-9));
}

Stretch shortest_stretch(std::span<const double> places, double containment) {
  const std::vector<double> s = sorted(places);
  const auto count = static_cast<double>(s.size());
  const auto needed =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(containment * count - 1e-9)), 1, s.size());
  std::size_t best = 0;
  for (std::size_t first = 1; first + needed <= s.size(); ++first)
    if (s[first + needed - 1] - s[first] < s[best + needed - 1] - s[best]) best = first;
  const double from = s[best], to = s[best + needed - 1];
  return {from, to, share_within(s, from, to)};
}

std::optional<Stretch> stretch_above(std::span<const double> places, double bin, double released, double probability) {
  const std::vector<double> s = sorted(places);
  std::optional<Stretch> found;
  for (auto first = s.begin(); first != s.end();) {
    const double from = std::floor(*first / bin) * bin;
    const auto end = std::lower_bound(first, s.end(), from + bin);
    const auto next = std::max(end, first + 1);  // rounding must not stop the progress
    if (static_cast<double>(next - first) > probability * released) {
      if (!found) found = Stretch{from, from + bin, 0.0};
      found->to = from + bin;
    }
    first = next;
  }
  if (found) found->share = share_within(s, found->from, found->to);
  return found;
}

}  // namespace talus
