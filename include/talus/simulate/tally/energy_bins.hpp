#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace talus {

/// Bins of energy for hazard curves: 8 to each doubling, equally wide within it (6.7 to 12.5 %). Every threshold
/// divides its bin, so that the exceedance of a threshold is a sum of whole bins.
///
/// Bin i holds the energies from edge(i) to edge(i + 1). An energy equal to an edge is in the bin above it; if the edge
/// is a threshold, in the bin below.
class EnergyBins {
 public:
  static constexpr float kFloor = 0x1p-7F;         ///< [kJ]; smaller energies count as this
  static constexpr float kCeiling = 0x1p40F;       ///< [kJ]; larger energies count as this
  static constexpr double kRelativeWidth = 0.125;  ///< largest relative width of a bin

  explicit EnergyBins(std::vector<double> thresholds = {});

  int of(float energy) const {
    const float clamped = energy > kFloor ? (energy < kCeiling ? energy : kCeiling) : kFloor;
    int bin = static_cast<int>(std::bit_cast<std::uint32_t>(clamped) >> kShift) - kFirstKey;
    for (const double threshold : thresholds_) bin += energy > threshold;
    return bin;
  }
  /// Lower edge of a bin, upper edge of the one before [kJ].
  double edge(int bin) const { return edges_[static_cast<std::size_t>(bin)]; }
  int count() const { return static_cast<int>(edges_.size()) - 1; }
  /// The first bin above a threshold.
  int above(std::size_t threshold) const { return first_above_[threshold]; }
  const std::vector<double>& thresholds() const { return thresholds_; }
  /// Index of the threshold of exactly this energy [kJ]; nothing if there is none.
  std::optional<std::size_t> threshold_at(double energy) const;

 private:
  static constexpr int kShift = 20;  // a float keeps 23 bits after the leading one: 3 of them number the bins
  static constexpr int kFirstKey = static_cast<int>(std::bit_cast<std::uint32_t>(kFloor) >> kShift);

  std::vector<double> thresholds_, edges_;
  std::vector<int> first_above_;
};

}  // namespace talus
