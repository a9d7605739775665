#pragma once
#include <array>
#include <cstdint>

#include "talus/base/elementary.hpp"

namespace talus {

using Words = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

/// The upper and the lower word of a product of two words.
template <class Word>
struct Product {
  Word high, low;
};
inline Product<std::uint32_t> product(std::uint32_t a, std::uint32_t b) {
  const std::uint64_t whole = std::uint64_t{a} * b;
  return {static_cast<std::uint32_t>(whole >> 32U), static_cast<std::uint32_t>(whole)};
}

/// Four words, and the key of two.
template <class Word>
struct Philox {
  Word c0, c1, c2, c3, k0, k1;

  /// Ten rounds of Philox4x32.
  [[gnu::always_inline]] void mix() {
    for (int round = 0; round < 10; ++round) {
      const Product<Word> first = product(0xD2511F53U, c0), second = product(0xCD9E8D57U, c2);
      c0 = second.high ^ c1 ^ k0;
      c1 = second.low;
      c2 = first.high ^ c3 ^ k1;
      c3 = first.low;
      k0 += 0x9E3779B9U;
      k1 += 0xBB67AE85U;
    }
  }
};

/// Four 32-bit words of Philox4x32-10 for a counter and a key.
/// Source: Salmon et al. (2011), "Parallel random numbers: as easy as 1, 2, 3"; the test has the known answers of
/// Random123.
inline Words philox4x32(Words counter, PhiloxKey key) {
  Philox<std::uint32_t> words{counter[0], counter[1], counter[2], counter[3], key[0], key[1]};
  words.mix();
  return {words.c0, words.c1, words.c2, words.c3};
}

/// Purpose of a draw. Each purpose has its own stream: switching an effect on never shifts the draws of the others.
enum class Purpose : std::uint32_t { Release = 0, Impact = 1, Stem = 2, Break = 3, Measurement = 100, Bootstrap = 101 };

inline double number_of(std::uint32_t word) {
  return static_cast<double>(word);
}

/// A number in the open interval (0, 1), in steps of 2^-32. It is never 0, so its logarithm is finite.
template <class Word>
inline auto uniform(Word word) {
  return (number_of(word) + 0.5) * 0x1p-32;
}

/// Two independent standard normal numbers from two uniform ones in (0, 1) (Box-Muller). |z| <= 6.8.
template <class Number>
struct NormalPair {
  Number first, second;
};
template <class Number>
inline NormalPair<Number> box_muller(Number u, Number turn) {
  const Number radius = root(-2.0 * natural_log(u));
  const BasicSineCosine<Number> direction = sine_cosine_of_turn(turn);
  return {radius * direction.cosine, radius * direction.sine};
}
/// Two standard normal numbers from two random words.
inline std::array<double, 2> normal_pair(std::uint32_t first, std::uint32_t second) {
  const NormalPair<double> pair = box_muller(uniform(first), uniform(second));
  return {pair.first, pair.second};
}

/// The random numbers of one block: a pure function of (seed, source, block, purpose, draw), with no state.
/// Results are therefore independent of threads, order and parts, and more blocks never change earlier ones.
/// Each piece that broke off a block has its own streams. `piece` is below 2^24; 0 is the block itself.
class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t source, std::uint32_t block, Purpose purpose, std::uint32_t piece = 0)
      : key_(key_of(seed)), source_(source), block_(block), purpose_(purpose_word(purpose, piece)) {}

  /// Four random words of an event, for instance of the block's 17th impact. `event` is below 2^24, `part` below 256.
  /// A rejection loop takes further parts of its own event and cannot shift the next event.
  Words words(std::uint32_t event, std::uint32_t part = 0) const {
    return philox4x32({first_word(event, part), purpose_, source_, block_}, key_);
  }

  // The words of a counter and its key, for the draws in lanes as well.
  static PhiloxKey key_of(std::uint64_t seed) {
    return {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)};
  }
  static std::uint32_t purpose_word(Purpose purpose, std::uint32_t piece) {
    return piece << 8U | static_cast<std::uint32_t>(purpose);
  }
  static std::uint32_t first_word(std::uint32_t event, std::uint32_t part) { return event << 8U | part; }

 private:
  PhiloxKey key_;
  std::uint32_t source_, block_, purpose_;
};

}  // namespace talus
