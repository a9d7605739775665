#pragma once
#include <array>

#include "talus/fit/campaign/observe.hpp"

namespace talus {

/// Shares at which distributions are compared.
inline constexpr std::array<double, 5> kCompared{0.05, 0.25, 0.5, 0.75, 0.95};

/// Measured and simulated values of one quantity, pooled over all asked blocks.
struct Distribution {
  std::string name;                                              ///< "runout", "speed S1", "sample spin", ...
  std::string unit;                                              ///< "m", "m/s", "rad/s"
  std::size_t measured_count = 0, simulated_count = 0;           ///< values
  std::array<double, kCompared.size()> measured{}, simulated{};  ///< quantiles
};

/// Share of the blocks that crossed a screen.
struct CrossingShare {
  std::string screen;
  double measured = 0.0, simulated = 0.0;
};

struct Comparison {
  std::vector<Distribution> distributions;
  std::vector<CrossingShare> crossings;
};

/// Compares the pooled distributions: runout (plan distance from the nominal place of release to the stop), and speed,
/// jump and spin at the screens and the samples; of mapped blocks distance and angle from the nearest source.
/// Quantities of fewer than five measured values are left out.
Comparison compare(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask);

}  // namespace talus
