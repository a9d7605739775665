#include "talus/products/barrier_design.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "talus/base/sample.hpp"
#include "talus/base/vector.hpp"

namespace talus {
namespace {

std::vector<LineCrossing> along_the_line(std::span<const LineCrossing> crossings) {
  std::vector<LineCrossing> copy(crossings.begin(), crossings.end());
  std::ranges::stable_sort(copy, {}, &LineCrossing::along);
  return copy;
}

template <class Quantity>
double percentile_of(std::span<const LineCrossing> crossings, double share, Quantity quantity) {
  std::vector<double> values, weights;
  for (const LineCrossing& crossing : crossings) {
    values.push_back(std::invoke(quantity, crossing));
    weights.push_back(crossing.weight);
  }
  return weighted_quantile(values, weights, share);
}

double weight_of(std::span<const LineCrossing> crossings) {
  double sum = 0.0;
  for (const LineCrossing& crossing : crossings) sum += crossing.weight;
  return sum;
}

/// Share of the weight for which `wanted` is true.
template <class Wanted>
double share_where(std::span<const LineCrossing> crossings, Wanted wanted) {
  double sum = 0.0;
  for (const LineCrossing& crossing : crossings) sum += wanted(crossing) ? crossing.weight : 0.0;
  return sum / weight_of(crossings);
}

double share_within(std::span<const LineCrossing> crossings, double from, double to) {
  return share_where(crossings, [&](const LineCrossing& c) { return c.along >= from && c.along <= to; });
}

StretchDesign design_stretch(std::span<const LineCrossing> crossings, const Stretch& stretch,
                             const DesignBlockRule& block, const DesignFactors& factors) {
  StretchDesign s;
  s.stretch = stretch;
  s.crossings = crossings.size();
  if (crossings.empty()) return s;
  s.sums = sums_of(crossings);
  for (const LineCrossing& crossing : crossings) {
    s.largest_energy = std::max(s.largest_energy, crossing.energy());
    s.largest_height = std::max(s.largest_height, crossing.height);
  }
  s.block = block.of(crossings);
  s.effective = effective_number(crossings);
  if (s.effective < static_cast<double>(fewest_for_percentile(factors.percentile)) - 1e-9) return s;
  s.design = design_barrier(crossings, s.block, factors);
  s.beyond = exceeded_by(crossings, *s.design);
  return s;
}

/// The first crossing of each block or piece on each stretch between two edges, along the line.
std::vector<std::vector<LineCrossing>> by_stretch(std::span<const LineCrossing> crossings,
                                                  std::span<const double> edges) {
  const std::span<const double> inner = edges.subspan(1, edges.size() - 2);
  std::vector<std::vector<LineCrossing>> of_stretch(edges.size() - 1);
  std::vector<std::unordered_set<std::size_t>> seen(of_stretch.size());
  for (const LineCrossing& crossing : crossings) {
    const auto i = static_cast<std::size_t>(std::ranges::upper_bound(inner, crossing.along) - inner.begin());
    if (crossing.piece == LineCrossing::kUnknown || seen[i].insert(crossing.piece).second)
      of_stretch[i].push_back(crossing);
  }
  for (std::vector<LineCrossing>& here : of_stretch) here = along_the_line(here);
  return of_stretch;
}

/// Number of blocks among crossings.
std::size_t blocks_of(std::span<const LineCrossing> crossings) {
  std::unordered_set<std::size_t> blocks;
  for (const LineCrossing& crossing : crossings) blocks.insert(crossing.block);
  return blocks.size();
}

}  // namespace

double weighted_quantile(std::span<const double> values, std::span<const double> weights, double share) {
  std::vector<std::pair<double, double>> sample;  // value, weight
  for (std::size_t i = 0; i < values.size(); ++i) sample.emplace_back(values[i], weights[i]);
  std::ranges::sort(sample);
  std::vector<double> ascending;
  double all = 0.0;
  for (const auto& [value, weight] : sample) {
    ascending.push_back(value);
    all += weight;
  }
  if (std::ranges::all_of(weights, [&](double w) { return w == weights.front(); })) return quantile(ascending, share);
  const double wanted = share * (all - 0.5 * (sample.front().second + sample.back().second));
  double place = 0.0;  // from the middle of the first weight
  for (std::size_t i = 1; i < sample.size(); ++i) {
    const double way = 0.5 * (sample[i - 1].second + sample[i].second);
    if (place + way >= wanted) return std::lerp(ascending[i - 1], ascending[i], (wanted - place) / way);
    place += way;
  }
  return ascending.back();
}

double CrossingSummer::Stratum::overlap(std::uint32_t blocks) const {
  return blocks > 1 ? std::max(0.0, sum * sum - squares) / (blocks - 1.0) : 0.0;
}

void CrossingSummer::add(const LineCrossing& crossing) {
  const auto [block, first] = blocks_.try_emplace(crossing.block, 0.0);
  const double before = block->second, w = crossing.weight;
  const double squares = w * (2.0 * before + w);  // (before + w)^2 - before^2
  block->second += w;
  sums_.sum += w;
  sums_.squares += squares;
  sums_.largest = std::max(sums_.largest, block->second);
  sums_.pieces = sums_.pieces || !first;
  Stratum& stratum = strata_[crossing.stratum];
  sums_.overlap -= stratum.overlap(crossing.stratum_blocks);
  stratum.sum += w;
  stratum.squares += squares;
  sums_.overlap += stratum.overlap(crossing.stratum_blocks);
}

CrossingSums sums_of(std::span<const LineCrossing> crossings) {
  CrossingSummer summer;
  for (const LineCrossing& crossing : crossings) summer.add(crossing);
  return summer.sums();
}

Bounded crossings_per_year(const CrossingSums& counted, const CrossingSums& line, const WeightScale& scale) {
  if (!line.pieces) return annual_frequency({counted.sum, counted.squares, counted.overlap}, scale);
  return gamma_interval(counted.sum, counted.squares, std::max(line.largest, scale.largest_weight()));
}

double effective_number(std::span<const LineCrossing> crossings) {
  double sum = 0.0, squares = 0.0;
  for (const LineCrossing& crossing : crossings) {
    sum += crossing.weight;
    squares += crossing.weight * crossing.weight;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

BarrierDesign design_barrier(std::span<const LineCrossing> crossings, const DesignBlock& block,
                             const DesignFactors& factors) {
  BarrierDesign d{};
  const double reach = factors.trajectory * factors.topography;
  d.speed_percentile = percentile_of(crossings, factors.percentile, &LineCrossing::speed);
  d.height_percentile = percentile_of(crossings, factors.percentile, &LineCrossing::height);
  d.energy_percentile = percentile_of(crossings, factors.percentile, &LineCrossing::energy);
  d.speed = d.speed_percentile * reach;
  d.mass = block.volume * block.density * factors.volume * factors.density;
  d.energy = 0.5 * d.mass * d.speed * d.speed;
  d.sel = factors.sel * d.energy;
  d.mel = factors.mel * d.energy;
  const double diameter = diameter_of(block.volume);
  d.freeboard = std::max(factors.freeboard, 0.5 * diameter);
  d.height = d.height_percentile * reach + d.freeboard;
  d.top = d.height_percentile * reach + diameter;
  return d;
}

std::size_t fewest_for_percentile(double percentile) {
  return static_cast<std::size_t>(std::ceil((1.0 - 1e-9) / (1.0 - percentile)));
}

Stretch shortest_stretch(std::span<const LineCrossing> crossings, double containment) {
  const std::vector<LineCrossing> sorted = along_the_line(crossings);
  const double all = weight_of(sorted),
               needed = (containment - 1e-9) * all;  // rounding must not ask for one block more
  Stretch best{sorted.front().along, sorted.back().along, 1.0};
  double held = 0.0;  // from `first` to `last`, both included
  for (std::size_t first = 0, last = 0; first < sorted.size(); ++first) {
    while (last < sorted.size() && held < needed) held += sorted[last++].weight;
    if (held < needed) break;
    const double to = sorted[std::max(last, first + 1) - 1].along;
    if (to - sorted[first].along < best.width()) best = {sorted[first].along, to, 1.0};
    held -= sorted[first].weight;
  }
  best.share = share_within(sorted, best.from, best.to);
  return best;
}

std::optional<Stretch> stretch_above(std::span<const LineCrossing> crossings, double bin, double released,
                                     double probability) {
  const std::vector<LineCrossing> s = along_the_line(crossings);
  const double most = probability * released + 1e-6;  // of a whole number of blocks: 0.05 of 200 are 10, not 9.999...
  std::optional<Stretch> found;
  for (auto first = s.begin(); first != s.end();) {
    const double from = std::floor(first->along / bin) * bin;
    const auto end = std::ranges::lower_bound(first, s.end(), from + bin, {}, &LineCrossing::along);
    const auto next = std::max(end, first + 1);  // rounding must not stop the progress
    if (static_cast<double>(blocks_of({first, next})) > most) {
      if (!found) found = Stretch{from, from + bin, 0.0};
      found->to = from + bin;
    }
    first = next;
  }
  if (found) found->share = share_within(s, found->from, found->to);
  return found;
}

std::vector<double> stretch_edges(std::span<const double> parts, double length) {
  std::vector<double> edges{0.0};
  double start = 0.0;
  for (const double part : parts) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(part / length - 1e-9)));
    for (int i = 1; i <= pieces; ++i) edges.push_back(start + part * (static_cast<double>(i) / pieces));
    start += part;
  }
  return edges;
}

DesignBlock DesignBlockRule::of(std::span<const LineCrossing> crossings) const {
  if (volume) return {*volume, density};
  return {std::ranges::max(crossings, {}, &LineCrossing::mass).mass / rock_density, density};
}

std::vector<StretchDesign> design_stretches(std::span<const LineCrossing> crossings, std::span<const double> edges,
                                            const DesignBlockRule& block, const DesignFactors& factors) {
  const std::vector<std::vector<LineCrossing>> of_stretch = by_stretch(crossings, edges);
  double all = 0.0;
  for (const std::vector<LineCrossing>& here : of_stretch)
    for (const LineCrossing& crossing : here) all += crossing.weight;
  std::vector<StretchDesign> stretches;
  for (std::size_t i = 0; i < of_stretch.size(); ++i)
    stretches.push_back(
        design_stretch(of_stretch[i], {edges[i], edges[i + 1], weight_of(of_stretch[i]) / all}, block, factors));
  return stretches;
}

DesignExceeded exceeded_by(std::span<const LineCrossing> crossings, const BarrierDesign& design) {
  return {share_where(crossings, [&](const LineCrossing& c) { return c.height > design.height; }),
          share_where(crossings, [&](const LineCrossing& c) { return c.energy() > design.sel; }),
          share_where(crossings, [&](const LineCrossing& c) { return c.energy() > design.mel; })};
}

}  // namespace talus
