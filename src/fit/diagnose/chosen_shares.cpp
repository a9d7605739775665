#include "chosen_shares.hpp"

#include <algorithm>

#include "talus/fit/score/bootstrap.hpp"

namespace talus {

std::vector<double> chosen_shares(const Score& base, std::span<const PricedObjective> candidates,
                                  std::span<const std::uint32_t> streams) {
  std::vector<Difference> all;
  all.reserve(candidates.size());
  for (const PricedObjective& c : candidates) {
    all.push_back(difference(base, c.objective, streams));
    for (double& draw : all.back().draws) draw += c.price;
  }
  std::vector<double> shares(candidates.size(), 0.0);
  if (all.empty()) return shares;
  const std::size_t draws = all.front().draws.size();
  for (std::size_t draw = 0; draw < draws; ++draw) {
    const auto best = std::ranges::min_element(all, {}, [draw](const Difference& d) { return d.draws[draw]; });
    shares[static_cast<std::size_t>(best - all.begin())] += 1.0 / static_cast<double>(draws);
  }
  return shares;
}

}  // namespace talus
