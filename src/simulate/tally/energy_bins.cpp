#include "talus/simulate/tally/energy_bins.hpp"

#include <algorithm>

namespace talus {

EnergyBins::EnergyBins(std::vector<double> thresholds) : thresholds_(std::move(thresholds)), edges_(thresholds_) {
  const int last = static_cast<int>(std::bit_cast<std::uint32_t>(kCeiling) >> kShift);
  for (int key = kFirstKey; key <= last + 1; ++key)
    edges_.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(key) << kShift));
  std::ranges::sort(edges_);
  for (const double threshold : thresholds_)  // of equal edges the threshold is the upper one
    first_above_.push_back(static_cast<int>(std::ranges::upper_bound(edges_, threshold) - edges_.begin()) - 1);
}

std::optional<std::size_t> EnergyBins::threshold_at(double energy) const {
  const auto known = std::ranges::find(thresholds_, energy);
  if (known == thresholds_.end()) return std::nullopt;
  return static_cast<std::size_t>(known - thresholds_.begin());
}

}  // namespace talus
