#include "talus/products/return_values.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace talus {
namespace {

/// The crossings from the largest value down, with the sums of each and all before it.
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
  for (const auto& [value, crossing] : sorted) {
    summer.add(*crossing);
    descending.values.push_back(value);
    descending.sums.push_back(summer.sums());
  }
  return descending;
}

/// The largest value that is reached once in `years` by one side of the frequency.
double once_in(double years, const Descending& crossings, const CrossingRate& rate, double Bounded::*side) {
  const auto is_rarer = [&](const CrossingSums& sums) { return rate(sums).*side * years < kOnce; };
  if (!is_rarer(CrossingSums{})) return std::numeric_limits<double>::infinity();
  const auto found = std::ranges::partition_point(crossings.sums, is_rarer);
  return found == crossings.sums.end() ? 0.0
                                       : crossings.values[static_cast<std::size_t>(found - crossings.sums.begin())];
}

}  // namespace

std::vector<Bounded> values_once_in(std::span<const double> years, std::span<const LineCrossing> crossings,
                                    const std::function<double(const LineCrossing&)>& value_of,
                                    const CrossingRate& rate) {
  const Descending descending = from_the_largest(crossings, value_of);
  std::vector<Bounded> values;
  for (const double period : years)
    values.push_back({once_in(period, descending, rate, &Bounded::value),
                      once_in(period, descending, rate, &Bounded::low),
                      once_in(period, descending, rate, &Bounded::high)});
  return values;
}

}  // namespace talus
