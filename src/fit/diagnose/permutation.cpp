#include "talus/fit/diagnose/permutation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "talus/fit/campaign/block_draws.hpp"

namespace talus {
namespace {

constexpr double kEqual = 1e-9;  // statistics closer than this, relative to their size, are equal

/// The units of each stratum, each in the order of its streams.
std::vector<std::vector<std::size_t>> members_of(const Units& units) {
  std::map<std::size_t, std::vector<std::size_t>> by_stratum;
  for (std::size_t i = 0; i < units.size(); ++i) by_stratum[units.strata[i]].push_back(i);
  std::vector<std::vector<std::size_t>> members;
  for (auto& [stratum, list] : by_stratum) {
    std::sort(list.begin(), list.end(),
              [&](std::size_t a, std::size_t b) { return units.streams[a] < units.streams[b]; });
    members.push_back(std::move(list));
  }
  return members;
}

/// Number of arrangements; infinite beyond 10^300.
double number_of(const std::vector<std::vector<std::size_t>>& members) {
  double log = 0.0;
  for (const auto& list : members) log += std::lgamma(static_cast<double>(list.size()) + 1.0);
  return std::round(std::exp(log));
}

}  // namespace

Arrangements::Arrangements(const Units& units, std::size_t at_most, std::uint64_t seed) {
  const auto members = members_of(units);
  exact_ = number_of(members) <= static_cast<double>(at_most);
  if (exact_)
    enumerate(members, units.size());
  else
    choose(units, members, at_most, seed);
}

/// Every combination of the permutations of the strata.
void Arrangements::enumerate(const std::vector<std::vector<std::size_t>>& members, std::size_t units) {
  std::vector<std::size_t> in_place(units);
  std::iota(in_place.begin(), in_place.end(), std::size_t{0});
  givers_ = {in_place};
  for (const std::vector<std::size_t>& list : members) {
    std::vector<std::size_t> order(list.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::size_t before = givers_.size();
    while (std::next_permutation(order.begin(), order.end()))
      for (std::size_t k = 0; k < before; ++k) {
        givers_.push_back(givers_[k]);
        for (std::size_t i = 0; i < list.size(); ++i) givers_.back()[list[i]] = list[order[i]];
      }
  }
}

/// Random permutations: the units of a stratum stand in the order of random keys.
void Arrangements::choose(const Units& units, const std::vector<std::vector<std::size_t>>& members, std::size_t at_most,
                          std::uint64_t seed) {
  givers_.assign(at_most, std::vector<std::size_t>(units.size()));
  std::iota(givers_.front().begin(), givers_.front().end(), std::size_t{0});
  std::vector<std::pair<double, std::size_t>> keyed;
  for (std::size_t number = 1; number < at_most; ++number)
    for (const std::vector<std::size_t>& list : members) {
      keyed.clear();
      for (std::size_t i = 0; i < list.size(); ++i)
        keyed.emplace_back(
            draw_of_block(seed, units.streams[list[i]], static_cast<std::uint32_t>(number), BlockDraw::Permutation), i);
      std::sort(keyed.begin(), keyed.end());
      for (std::size_t i = 0; i < list.size(); ++i) givers_[number][list[i]] = list[keyed[i].second];
    }
}

PermutationTest Arrangements::test(const std::function<double(std::span<const std::size_t>)>& statistic) const {
  std::vector<double> all;
  for (const std::vector<std::size_t>& givers : givers_) all.push_back(statistic(givers));
  const auto share_of = [&all](double value) {  // of those as large
    const double enough = value - kEqual * std::max(1.0, std::abs(value));
    return static_cast<double>(std::ranges::count_if(all, [=](double other) { return other >= enough; })) /
           static_cast<double>(all.size());
  };
  return {share_of(all.front()), all.size(), exact_, share_of(std::ranges::max(all))};
}

}  // namespace talus
