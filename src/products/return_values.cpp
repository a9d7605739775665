#include "talus/products/return_values.hpp"

#include <algorithm>
#include <limits>
#include <unordered_set>
#include <utility>

namespace talus {
namespace {

/// The crossings from the largest value down, with the sums of each and all before it. Of a block that broke its piece
/// with the largest value counts, once.
struct Descending {
  std::vector<double> values;
  std::vector<CrossingSums> sums;
};

Descending from_the_largest(std::span<const LineCrossing> crossings,
                            const std::function<double(const LineCrossing&)>& value_of) {
  std::vector<std::pair<double, const LineCrossing*>> sorted;
  for (const LineCrossing& crossing : crossings) sorted.emplace_back(value_of(crossing), &crossing);
  std::ranges::stable_sort(sorted, std::greater{}, [](const auto& pair) { return pair.first; });
  Descending descending;
  CrossingSummer summer;
  std::unordered_set<std::size_t> blocks;
  for (const auto& [value, crossing] : sorted) {
    if (!blocks.insert(crossing->block).second) continue;
    summer.add(*crossing);
    descending.values.push_back(value);
    descending.sums.push_back(summer.sums());
  }
  return descending;
}

/// The largest values that are reached once in `years`, by the frequency and its bounds.
Bounded once_in(double years, const Descending& crossings, const CrossingRate& rate) {
  const auto is_rarer = [&](double Bounded::*side) {
    return [&rate, years, side](const CrossingSums& sums) { return rate(sums).*side * years < kOnce; };
  };
  const auto value_at = [&](auto found) {
    return found == crossings.sums.end() ? 0.0
                                         : crossings.values[static_cast<std::size_t>(found - crossings.sums.begin())];
  };
  const auto found = std::ranges::partition_point(crossings.sums, is_rarer(&Bounded::value));
  // The lower bound may fall with a heavy crossing after light ones: it is not bisected, but the first one is sought.
  const auto low = std::find_if_not(found, crossings.sums.end(), is_rarer(&Bounded::low));
  const bool known = is_rarer(&Bounded::high)(CrossingSums{});
  const auto high = std::ranges::partition_point(crossings.sums, is_rarer(&Bounded::high));
  return {value_at(found), value_at(low), known ? value_at(high) : std::numeric_limits<double>::infinity()};
}

}  // namespace

std::vector<Bounded> values_once_in(std::span<const double> years, std::span<const LineCrossing> crossings,
                                    const std::function<double(const LineCrossing&)>& value_of,
                                    const CrossingRate& rate) {
  const Descending descending = from_the_largest(crossings, value_of);
  std::vector<Bounded> values;
  for (const double period : years) values.push_back(once_in(period, descending, rate));
  return values;
}

}  // namespace talus
