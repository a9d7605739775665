#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "talus/base/elementary.hpp"

namespace talus {

using Words = std::array<std::uint32_t, 4>;

/// Four 32-bit words of Philox4x32-10 for a counter and a key.
/// Source: Salmon et al. (2011), "Parallel random numbers: as easy as 1, 2, 3"; the test has the known answers of
/// Random123.
inline Words philox4x32(Words counter, std::array<std::uint32_t, 2> key) {
  auto [c0, c1, c2, c3] = counter;
  auto [k0, k1] = key;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = std::uint64_t{0xD2511F53U} * c0;
    const std::uint64_t second = std::uint64_t{0xCD9E8D57U} * c2;
    c0 = static_cast<std::uint32_t>(second >> 32U) ^ c1 ^ k0;
    c1 = static_cast<std::uint32_t>(second);
    c2 = static_cast<std::uint32_t>(first >> 32U) ^ c3 ^ k1;
    c3 = static_cast<std::uint32_t>(first);
    k0 += 0x9E3779B9U;
    k1 += 0xBB67AE85U;
  }
  return {c0, c1, c2, c3};
}

/// Purpose of a draw. Each purpose has its own stream: switching an effect on never shifts the draws of the others.
enum class Purpose : std::uint32_t { Release = 0, Impact = 1, Stem = 2, Break = 3, Measurement = 100, Bootstrap = 101 };

/// A number in the open interval (0, 1), in steps of 2^-32. It is never 0, so its logarithm is finite.
inline double uniform(std::uint32_t word) {
  return (static_cast<double>(word) + 0.5) * 0x1p-32;
}

/// Two independent standard normal numbers from two words (Box-Muller). |z| <= 6.8.
inline std::array<double, 2> normal_pair(std::uint32_t first, std::uint32_t second) {
  const double radius = std::sqrt(-2.0 * natural_log(uniform(first)));
  const SineCosine direction = sine_cosine_of_turn(uniform(second));
  return {radius * direction.cosine, radius * direction.sine};
}

/// The random numbers of one block: a pure function of (seed, source, block, purpose, draw), with no state.
/// Results are therefore independent of threads, order and parts, and more blocks never change earlier ones.
/// Each piece that broke off a block has its own streams. `piece` is below 2^24; 0 is the block itself.
class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t source, std::uint32_t block, Purpose purpose, std::uint32_t piece = 0)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)},
        source_(source),
        block_(block),
        purpose_(piece << 8U | static_cast<std::uint32_t>(purpose)) {}

  /// Four random words of an event, for instance of the block's 17th impact. `event` is below 2^24, `part` below 256.
  /// A rejection loop takes further parts of its own event and cannot shift the next event.
  Words words(std::uint32_t event, std::uint32_t part = 0) const {
    return philox4x32({event << 8U | part, purpose_, source_, block_}, key_);
  }

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint32_t source_, block_, purpose_;
};

}  // namespace talus
