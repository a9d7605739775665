#include "talus/base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "support/scenes.hpp"

namespace talus {
namespace {

// Source: Random123 1.14, kat_vectors, "philox4x32 10".
TEST(Philox, KnownAnswers) {
  constexpr std::uint32_t kOnes = 0xffffffffU;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U}));
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}));
  EXPECT_EQ(philox4x32({0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}, {0xa4093822U, 0x299f31d0U}),
            (Words{0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}));
}

TEST(Uniform, NeverZeroNorOneAndEvenlySpaced) {
  EXPECT_EQ(uniform(0), 0x1p-33);
  EXPECT_EQ(uniform(0xffffffffU), 1.0 - 0x1p-33);
  EXPECT_LT(uniform(0xffffffffU), 1.0);
  test::Numbers numbers(1);
  for (int i = 0; i < 1000; ++i) {
    const auto word = static_cast<std::uint32_t>(numbers.bits() % 0xffffffffU);
    EXPECT_EQ(uniform(word + 1) - uniform(word), 0x1p-32);
  }
}

TEST(Random, UniformMeanAndVarianceOfEveryWord) {
  constexpr int kDraws = 500'000;
  for (int word = 0; word < 4; ++word) {
    double sum = 0.0, squares = 0.0;
    for (std::uint32_t block = 0; block < kDraws; ++block) {
      const double u = uniform(Random(1, 0, block, Purpose::Impact).words(0)[static_cast<std::size_t>(word)]) - 0.5;
      sum += u;
      squares += u * u;
    }
    EXPECT_NEAR(sum / kDraws, 0.0, 5.0 * std::sqrt(1.0 / 12.0 / kDraws));              // a bias of 0.2 % fails
    EXPECT_NEAR(squares / kDraws, 1.0 / 12.0, 5.0 * std::sqrt(1.0 / 180.0 / kDraws));  // var u^2 = 1/80 - 1/144
  }
}

TEST(NormalPair, MomentsAndTails) {
  constexpr int kDraws = 1'000'000;
  constexpr double kN = 2.0 * kDraws;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0, cross = 0, cross2 = 0, above[4] = {}, largest = 0;
  constexpr double kQuantile[4] = {0.0, 1.6448536269514722, 3.0, 4.0};
  constexpr double kTail[4] = {0.5, 0.05, 1.3498980316300946e-3, 3.1671241833119924e-5};
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const Words w = Random(7, 3, i, Purpose::Impact).words(5);
    const auto pair = normal_pair(w[0], w[1]);
    for (const double z : pair) {
      m1 += z, m2 += z * z, m3 += z * z * z, m4 += z * z * z * z;
      for (int k = 0; k < 4; ++k) above[k] += z > kQuantile[k] ? 1.0 : 0.0;
      largest = std::max(largest, std::abs(z));
    }
    cross += pair[0] * pair[1];
    cross2 += pair[0] * pair[0] * pair[1] * pair[1];
  }
  EXPECT_NEAR(m1 / kN, 0.0, 5.0 * std::sqrt(1.0 / kN));
  EXPECT_NEAR(m2 / kN, 1.0, 5.0 * std::sqrt(2.0 / kN));
  EXPECT_NEAR(m3 / kN, 0.0, 5.0 * std::sqrt(15.0 / kN));
  EXPECT_NEAR(m4 / kN, 3.0, 5.0 * std::sqrt(96.0 / kN));
  EXPECT_NEAR(cross / kDraws, 0.0, 5.0 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(cross2 / kDraws, 1.0, 5.0 * std::sqrt(8.0 / kDraws));
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(above[k] / kN, kTail[k], 5.0 * std::sqrt(kTail[k] / kN)) << kQuantile[k];
  EXPECT_LE(largest, 6.8);
}

TEST(NormalPair, ExtremeWordsAreFinite) {
  const double largest = std::sqrt(66.0 * std::log(2.0));  // sqrt(-2 ln 2^-33) = 6.764
  EXPECT_NEAR(normal_pair(0, 0)[0], largest, 1e-6);        // direction 2^-33 of a turn
  EXPECT_NEAR(normal_pair(0, 0x80000000U)[0], -largest, 1e-6);
  EXPECT_NEAR(normal_pair(0, 0x40000000U)[1], largest, 1e-6);
  EXPECT_GT(std::abs(normal_pair(0xffffffffU, 0)[0]), 0.0);
  EXPECT_LT(std::abs(normal_pair(0xffffffffU, 0)[0]), 2e-5);  // sqrt(2^-32)
}

constexpr int kPairs = 1'000'000;
constexpr int kBins = 16;  // of each word, by its leading four bits

/// Chi-square of pairs of words in a table of kBins x kBins equally likely cells, in standard deviations from its mean.
template <class A, class B>
double excess_of_chi_square(A first, B second) {
  std::array<std::array<int, kBins>, kBins> counts{};
  for (std::uint32_t i = 0; i < kPairs; ++i) ++counts[first(i) >> 28U][second(i) >> 28U];
  constexpr double kExpected = double(kPairs) / (kBins * kBins), kFreedom = kBins * kBins - 1;
  double sum = 0.0;
  for (const auto& row : counts)
    for (const int count : row) sum += (count - kExpected) * (count - kExpected) / kExpected;
  return (sum - kFreedom) / std::sqrt(2.0 * kFreedom);
}

/// Independence of words over neighbours in one coordinate of the key, at five standard deviations. Found with a
/// probability above 0.998 (three standard deviations more): a correlation of 0.008, and any dependence whose
/// phi-square, the sum of (256 p - 1)^2 / 256 over the cells, is 2.4e-4, as where 0.4 % of the words are copies.
template <class A, class B>
void expect_independent(A first, B second, const char* what) {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < kPairs; ++i) sum += (uniform(first(i)) - 0.5) * (uniform(second(i)) - 0.5);
  EXPECT_NEAR(12.0 * sum / kPairs, 0.0, 5.0 / std::sqrt(kPairs)) << what;
  EXPECT_LT(std::abs(excess_of_chi_square(first, second)), 5.0) << what;
}

TEST(Random, TheBatteryFindsAWeakDependence) {
  const auto base = [](std::uint32_t i) { return Random(1, 0, i, Purpose::Impact).words(0)[0]; };
  const auto other = [](std::uint32_t i) { return Random(2, 0, i, Purpose::Impact).words(0)[0]; };
  const auto copied = [&](std::uint32_t i) { return i % 250 == 0 ? base(i) : other(i); };
  EXPECT_GT(excess_of_chi_square(base, copied), 5.0);
  const auto folded = [&](std::uint32_t i) {  // small where the other is near its middle: no correlation
    const std::uint32_t word = base(i);
    return i % 200 == 0 ? 2U * (word < 0x80000000U ? 0x7fffffffU - word : word - 0x80000000U) : other(i);
  };
  EXPECT_GT(excess_of_chi_square(base, folded), 5.0);
}

TEST(Random, NeighboursAreIndependent) {
  const auto base = [](std::uint32_t i) { return Random(1, 0, i, Purpose::Impact).words(0)[0]; };
  expect_independent(
      base, [](auto i) { return Random(1, 0, i, Purpose::Release).words(0)[0]; }, "purpose");
  expect_independent(
      base, [](auto i) { return Random(2, 0, i, Purpose::Impact).words(0)[0]; }, "seed");
  expect_independent(
      base, [](auto i) { return Random(1ULL + (1ULL << 32), 0, i, Purpose::Impact).words(0)[0]; }, "seed high");
  expect_independent(
      base, [](auto i) { return Random(1, 1, i, Purpose::Impact).words(0)[0]; }, "source");
  expect_independent(
      base, [](auto i) { return Random(1, 0, i + 1, Purpose::Impact).words(0)[0]; }, "block");
  expect_independent(
      base, [](auto i) { return Random(1, 0, i, Purpose::Impact).words(1)[0]; }, "event");
  expect_independent(
      base, [](auto i) { return Random(1, 0, i, Purpose::Impact).words(0, 1)[0]; }, "part");
  expect_independent(
      base, [](auto i) { return Random(1, 0, i, Purpose::Impact).words(0)[1]; }, "word");
}

TEST(Random, NoTwoKeysShareTheirWords) {  // the trap: stream i of seed s is stream i - 1 of seed s + 1
  std::set<Words> seen;
  std::size_t drawn = 0;
  for (const std::uint64_t seed : {0ULL, 1ULL, 2ULL, 1ULL << 32, (1ULL << 32) + 1})
    for (std::uint32_t source = 0; source < 5; ++source)
      for (std::uint32_t block = 0; block < 5; ++block)
        for (const Purpose purpose : {Purpose::Release, Purpose::Impact})
          for (const std::uint32_t event : {0U, 1U, 2U, 3U, 256U, (1U << 24) - 1})
            for (const std::uint32_t part : {0U, 1U, 2U, 255U}) {
              seen.insert(Random(seed, source, block, purpose).words(event, part));
              ++drawn;
            }
  EXPECT_EQ(seen.size(), drawn);
}

TEST(Random, IsAPureFunctionOfItsKey) {
  const Random one(99, 4, 17, Purpose::Impact), same(99, 4, 17, Purpose::Impact);
  const Words later = one.words(12);
  for (std::uint32_t event = 0; event < 12; ++event) static_cast<void>(same.words(event, event));
  EXPECT_EQ(same.words(12), later);
}

}  // namespace
}  // namespace talus
