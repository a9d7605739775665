#pragma once
#include <cstdint>
#include <optional>

#include "talus/simulate/tally/tally.hpp"

namespace talus {

inline constexpr std::uint32_t kMostRounds = 10'000;  ///< that a run may have

/// Rounds of a run. Each round traces all trajectories of the scenario again, with new random numbers.
struct Rounds {
  std::uint32_t count = 1;            ///< number of rounds, if no error is asked for
  std::optional<double> until_error;  ///< add rounds until the relative half-width is below this [-]
  double above = 0.01;                ///< only cells with a larger impact probability are checked [-]
  std::uint32_t most = 100;           ///< largest number of rounds, even if the error is not reached
  bool several() const { return count > 1 || until_error.has_value(); }
  std::uint32_t at_most() const { return until_error ? most : count; }  ///< largest number of rounds there can be
  /// Whether both ask for the same: `above` counts where there are several, `most` with `until_error`, else `count`.
  bool operator==(const Rounds& other) const {
    if (until_error != other.until_error || at_most() != other.at_most()) return false;
    return !several() || above == other.above;
  }
};

/// Statistical error of the impact probability.
struct Accuracy {
  double half_width = 0.0;  ///< largest relative half-width of the 95 % bounds: (upper - lower) / (2 p)
  std::uint64_t cells = 0;  ///< number of cells checked
};

/// The largest error among the cells with a probability above `above`; both numbers are 0 if there are none.
Accuracy accuracy_of(const Tally& tally, std::uint64_t released, double above);

}  // namespace talus
