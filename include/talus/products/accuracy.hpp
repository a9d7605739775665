#pragma once
#include <cstdint>
#include <optional>

#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// How often the trajectories of a scenario are traced, each time with further random numbers.
struct Rounds {
  std::uint32_t count = 1;            ///< where nothing is asked of the error
  std::optional<double> until_error;  ///< relative half-width of the impact probability
  double above = 0.01;                ///< in all cells with a larger probability
  std::uint32_t most = 100;           ///< rounds, whatever is reached
  bool several() const { return count > 1 || until_error.has_value(); }
  bool operator==(const Rounds&) const = default;
};

/// How well the impact probability is known.
struct Accuracy {
  double half_width = 0.0;  ///< largest relative half-width of the 95 % bounds: (upper - lower) / (2 p)
  std::uint64_t cells = 0;  ///< of so many
};

/// Of the cells with a probability above `above`; 0 where there are none.
Accuracy accuracy_of(const Tally& tally, std::uint64_t released, double above);

}  // namespace talus
