#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "talus/fit/score/score.hpp"

namespace talus {

/// The objective of a candidate, and the gain that its fitted numbers must bring.
struct PricedObjective {
  std::reference_wrapper<const Score> objective;
  double price = 0.0;
};

/// How often each candidate has the lowest error when blocks get random weights (`bootstrap_weights`); the shares sum
/// to 1.
///
/// @param base     the objective without any of them
/// @param streams  of the blocks
std::vector<double> chosen_shares(const Score& base, std::span<const PricedObjective> candidates,
                                  std::span<const std::uint32_t> streams);

}  // namespace talus
