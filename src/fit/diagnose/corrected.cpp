#include "talus/fit/diagnose/corrected.hpp"

#include <algorithm>
#include <utility>

namespace talus {

Corrected corrected(std::span<const std::vector<double>> simulated, std::span<const double> measured) {
  // Number of data sets with a p-value of an effect as small, then that p-value: it decides between equal numbers of
  // two effects.
  using Rarity = std::pair<double, double>;
  const std::size_t n = simulated.front().size();
  const auto sets = static_cast<double>(n + 1);
  std::vector<Rarity> rarest(n, {sets, 1.0});  // by data set: by its most unlikely effect
  Rarity own{sets, 1.0};
  Corrected out;
  for (std::size_t e = 0; e < simulated.size(); ++e) {
    std::vector<double> sorted = simulated[e];
    sorted.push_back(measured[e]);
    std::sort(sorted.begin(), sorted.end());
    const auto rarity = [&sorted](double p) {
      return Rarity{std::upper_bound(sorted.begin(), sorted.end(), p) - sorted.begin(), p};
    };
    for (std::size_t set = 0; set < n; ++set) rarest[set] = std::min(rarest[set], rarity(simulated[e][set]));
    own = std::min(own, rarity(measured[e]));
    out.effects.push_back(rarity(measured[e]).first / sets);
  }
  const auto as_rare = std::count_if(rarest.begin(), rarest.end(), [&](const Rarity& r) { return r <= own; });
  out.all = (static_cast<double>(as_rare) + 1.0) / sets;
  return out;
}

}  // namespace talus
