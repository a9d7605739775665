#include "talus/base/elementary.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cfloat>
#include <cmath>
#include <limits>

#include "support/scenes.hpp"
#include "talus/base/random.hpp"

namespace talus {
namespace {

using test::Numbers;

constexpr long double kTwoPi = 6.283185307179586476925286766559005768L;

/// Error in units of the last place of the true value.
double ulps(double value, long double exact) {
  const double near = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(near, std::numeric_limits<double>::infinity()) - near;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact)) / unit;
}

class AgainstLongDouble : public testing::Test {
  void SetUp() override {
    if (LDBL_MANT_DIG < 64) GTEST_SKIP() << "long double is no wider than double here";
  }
};
using NaturalLog = AgainstLongDouble;
using SineCosineOfTurn = AgainstLongDouble;
using AngleOfRise = AgainstLongDouble;

TEST_F(NaturalLog, BelowTwoUlpOverAllNormalNumbers) {
  Numbers numbers(11);
  double worst = 0.0;
  for (int i = 0; i < 3'000'000; ++i) {
    const std::uint64_t exponent = 1 + numbers.bits() % 2046;  // every binade of normal numbers
    const double x = std::bit_cast<double>(exponent << 52 | numbers.bits() >> 12);
    worst = std::max(worst, ulps(natural_log(x), std::log(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 2.0);
}

TEST_F(NaturalLog, WordsOfTheRandomNumbers) {  // all that the engine takes logarithms of
  Numbers numbers(12);
  double worst = 0.0;
  for (int i = 0; i < 1'000'000; ++i) {
    const double x = uniform(static_cast<std::uint32_t>(numbers.bits()));
    worst = std::max(worst, ulps(natural_log(x), std::log(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 2.0);
}

TEST_F(NaturalLog, NearOne) {
  Numbers numbers(13);
  double worst = 0.0, absolute = 0.0;
  const auto look = [&](double x) {
    const long double exact = std::log(static_cast<long double>(x));
    worst = std::max(worst, ulps(natural_log(x), exact));
    absolute = std::max(absolute, std::abs(static_cast<double>(natural_log(x) - exact)));
  };
  for (int i = 0; i < 1'000'000; ++i)
    look(1.0 + std::copysign(std::exp2(numbers.uniform(-52.0, -2.0)), numbers.uniform(-1, 1)));
  double x = 1.0;
  for (int i = 0; i < 1000; ++i) look(x = std::nextafter(x, 2.0));
  EXPECT_LT(worst, 2.0);
  EXPECT_LT(absolute, 1e-16);
}

TEST_F(NaturalLog, BothSidesOfTheSeamOfTheMantissa) {  // sqrt(2) and sqrt(1/2)
  for (const double root : {std::sqrt(2.0), std::sqrt(0.5), std::sqrt(2.0) * 0x1p-20})
    for (double x = root * (1.0 - 8 * test::kEps); x < root * (1.0 + 8 * test::kEps); x = std::nextafter(x, 1e9))
      EXPECT_LT(ulps(natural_log(x), std::log(static_cast<long double>(x))), 2.0) << x;
}

TEST(NaturalLogValues, ExactAtOneAndMonotonousNearby) {
  EXPECT_EQ(natural_log(1.0), 0.0);
  EXPECT_LT(natural_log(std::nextafter(1.0, 0.0)), 0.0);
  EXPECT_GT(natural_log(std::nextafter(1.0, 2.0)), 0.0);
}

TEST_F(SineCosineOfTurn, Below3e16) {
  Numbers numbers(14);
  double sine = 0.0, cosine = 0.0, circle = 0.0;
  for (int i = 0; i < 4'000'000; ++i) {
    const double turn = i % 4 == 0 ? numbers.uniform(0.0, 1.0) : uniform(static_cast<std::uint32_t>(numbers.bits()));
    const SineCosine value = sine_cosine_of_turn(turn);
    sine = std::max(sine, static_cast<double>(std::abs(value.sine - std::sin(kTwoPi * turn))));
    cosine = std::max(cosine, static_cast<double>(std::abs(value.cosine - std::cos(kTwoPi * turn))));
    circle = std::max(circle, std::abs(value.sine * value.sine + value.cosine * value.cosine - 1.0));
  }
  EXPECT_LT(sine, 3e-16);
  EXPECT_LT(cosine, 3e-16);
  EXPECT_LT(circle, 1e-15);
}

TEST_F(SineCosineOfTurn, SeamsOfTheEighths) {
  for (int eighth = 0; eighth <= 8; ++eighth)
    for (const double step : {-0x1p-53, -0x1p-40, 0.0, 0x1p-40, 0x1p-52}) {
      const double turn = 0.125 * eighth + step;
      if (turn < 0.0 || turn > 1.0) continue;
      const SineCosine value = sine_cosine_of_turn(turn);
      EXPECT_LT(std::abs(value.sine - std::sin(kTwoPi * turn)), 3e-16L) << turn;
      EXPECT_LT(std::abs(value.cosine - std::cos(kTwoPi * turn)), 3e-16L) << turn;
    }
}

TEST(SineCosineOfTurnValues, QuarterTurnsAreExact) {
  const double sine[] = {0.0, 1.0, 0.0, -1.0, 0.0}, cosine[] = {1.0, 0.0, -1.0, 0.0, 1.0};
  for (int quarter = 0; quarter <= 4; ++quarter) {
    EXPECT_EQ(sine_cosine_of_turn(0.25 * quarter).sine, sine[quarter]);
    EXPECT_EQ(sine_cosine_of_turn(0.25 * quarter).cosine, cosine[quarter]);
  }
}

TEST_F(AngleOfRise, IsTheArcTangentOfTheRatio) {
  Numbers numbers(15);
  double worst = 0.0;
  for (int i = 0; i < 1'000'000; ++i) {
    const double way = std::exp(numbers.uniform(-3.0, 8.0)), rise = way * std::tan(numbers.uniform(-1.57, 1.57));
    worst = std::max(worst, ulps(angle_of_rise(rise, way), std::atan2(static_cast<long double>(rise), way)));
  }
  EXPECT_LT(worst, 8.0);
}

TEST(AngleOfRiseValues, OfTheHorizontalAndOfEqualSides) {
  EXPECT_EQ(angle_of_rise(0.0, 3.0), 0.0);
  EXPECT_NEAR(angle_of_rise(2.0, 2.0), 0.25 * kPi, 2e-16);
  EXPECT_NEAR(angle_of_rise(-2.0, 2.0), -0.25 * kPi, 2e-16);
}

}  // namespace
}  // namespace talus
