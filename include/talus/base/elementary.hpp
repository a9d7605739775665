#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "talus/base/lane.hpp"
#include "talus/base/vector.hpp"

namespace talus {

/// Logarithm, exponential, power, sine, cosine and their inverses, made of +, -, *, /, roots and rounding only, so that
/// the same program gives the same bits on every IEEE 754 machine. Those of the C library differ between processors
/// with and without fused multiply-add. The logarithm and the sine/cosine have no branches, so that the processor can
/// overlap several calls.

/// x = mantissa 2^exponent, with the mantissa in [sqrt(1/2), sqrt(2)).
template <class Number>
struct Scaled {
  Number mantissa, exponent;
};
inline constexpr std::uint64_t kRootHalf = 0x3FE6A09E00000000ULL;  // sqrt(1/2), its upper half
inline Scaled<double> scaled(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto exponent = static_cast<std::int32_t>((bits - kRootHalf) >> 32U) >> 20;
  return {std::bit_cast<double>(bits - (static_cast<std::uint64_t>(static_cast<std::int64_t>(exponent)) << 52U)),
          static_cast<double>(exponent)};
}

/// ln(x).
///
/// @param x  (0, inf), a normal number; anything else is undefined
///
/// Error: below 2 ulp, and below 1e-16 absolute near x = 1. Source: atanh series on the mantissa.
template <class Number>
inline Number natural_log(Number x) {
  const auto [m, e] = scaled(x);
  const Number s = (m - 1.0) / (m + 1.0);  // ln m = 2 atanh s, |s| < 0.1716
  const Number q = s * s, q2 = q * q, q4 = q2 * q2;
  const Number series = q * ((1.0 / 3 + q * (1.0 / 5)) + q2 * (1.0 / 7 + q * (1.0 / 9)) +
                             q4 * ((1.0 / 11 + q * (1.0 / 13)) + q2 * (1.0 / 15 + q * (1.0 / 17)) + q4 * (1.0 / 19)));
  constexpr double kLn2High = 0x1.62e42fefa3800p-1, kLn2Low = 0x1.ef35793c76730p-45;
  return e * kLn2High + (2.0 * s + (2.0 * s * series + e * kLn2Low));
}

/// (e^x - 1 - x) / x^2, |x| <= 0.5. Error: below 2 ulp. Source: Taylor polynomial.
inline double exponential_rest(double x) {
  const double x2 = x * x, x4 = x2 * x2;
  const double first = (1.0 / 2 + x * (1.0 / 6)) + x2 * (1.0 / 24 + x * (1.0 / 120));
  const double second = (1.0 / 720 + x * (1.0 / 5040)) + x2 * (1.0 / 40320 + x * (1.0 / 362880));
  const double third = (1.0 / 3628800 + x * (1.0 / 39916800)) +
                       x2 * (1.0 / 479001600 + x * (1.0 / 6227020800) + x2 * (1.0 / 87178291200));
  return first + x4 * (second + x4 * third);
}

/// e^x; exactly 1 at 0. Outside +-700 it returns the value at +-700. NaN gives NaN.
///
/// Error: below 2 ulp for |x| <= 1, 4 ulp elsewhere. Source: Taylor polynomial on [-ln 2 / 2, ln 2 / 2].
inline double exponential(double x) {
  if (x == 0.0) return 1.0;  // exact for an effect that is off
  if (std::isnan(x)) return x;
  constexpr double kLn2High = 0x1.62e42fefa3800p-1, kLn2Low = 0x1.ef35793c76730p-45, kPerLn2 = 1.4426950408889634;
  const double bounded = std::clamp(x, -700.0, 700.0);
  const double k = std::floor(bounded * kPerLn2 + 0.5);
  const double r = (bounded - k * kLn2High) - k * kLn2Low;
  const double sum = 1.0 + (r + r * r * exponential_rest(r));
  return sum * std::bit_cast<double>((static_cast<std::int64_t>(k) + 1023) << 52U);
}

/// x^p for a positive normal x and p ln x within +-700; exactly 1 at p = 0. Error: below (4 + 2 |p ln x|) ulp.
inline double power(double x, double p) {
  if (p == 0.0) return 1.0;
  return exponential(p * natural_log(x));
}

template <class Number>
struct BasicSineCosine {
  Number sine;
  Number cosine;
};
using SineCosine = BasicSineCosine<double>;

/// The quarter turn nearest to a fraction of a turn: 0 .. 4.
inline int nearest_quarter(double turn) {
  return (static_cast<int>(8.0 * turn) + 1) / 2;
}
/// Sine and cosine of an angle that is larger by some quarter turns.
inline SineCosine turned(int quarter, double sine, double cosine) {
  const bool swap = (quarter & 1) != 0;
  const double sine_sign = (quarter & 2) != 0 ? -1.0 : 1.0;          // quarters 2 and 3
  const double cosine_sign = ((quarter + 1) & 2) != 0 ? -1.0 : 1.0;  // quarters 1 and 2
  return {sine_sign * (swap ? cosine : sine), cosine_sign * (swap ? sine : cosine)};
}

/// Sine and cosine of a fraction u of a full turn: sin(2 pi u), cos(2 pi u).
///
/// @param turn  u in [0, 1]
///
/// Error: below 3e-16 absolute. Source: Taylor polynomials on an eighth of a turn.
template <class Number>
inline BasicSineCosine<Number> sine_cosine_of_turn(Number turn) {
  const auto quarter = nearest_quarter(turn);
  const Number x = (turn - 0.25 * quarter) * (2.0 * kPi);  // |x| <= pi/4; the difference is exact
  const Number q = x * x, q2 = q * q, q4 = q2 * q2;
  const Number sine = x * ((1.0 - q * (1.0 / 6)) + q2 * (1.0 / 120 - q * (1.0 / 5040)) +
                           q4 * ((1.0 / 362880 - q * (1.0 / 39916800)) +
                                 q2 * (1.0 / 6227020800 - q * (1.0 / 1307674368000)) + q4 * (1.0 / 355687428096000)));
  const Number cosine = (1.0 - q * 0.5) + q2 * (1.0 / 24 - q * (1.0 / 720)) +
                        q4 * ((1.0 / 40320 - q * (1.0 / 3628800)) + q2 * (1.0 / 479001600 - q * (1.0 / 87178291200)) +
                              q4 * (1.0 / 20922789888000));
  return turned(quarter, sine, cosine);
}

/// Coefficients of asin(x)/x in powers of x^2: (2n)! / (4^n n!^2 (2n + 1)).
inline constexpr std::array<double, 12> kArcSine = [] {
  std::array<double, 12> series{};
  double c = 1.0;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const auto k = static_cast<double>(n);
    series[n] = c / (2.0 * k + 1.0);
    c *= (2.0 * k + 1.0) / (2.0 * k + 2.0);
  }
  return series;
}();

/// asin(x) for 0 <= x <= sqrt(1/2). Source: its series after halving the angle twice. Error: below 6 ulp, 1.5 of each
/// halving.
inline double arc_sine(double x) {
  for (int halving = 0; halving < 2; ++halving) x /= std::sqrt(2.0 + 2.0 * std::sqrt(1.0 - x * x));
  const double q = x * x;  // below 0.0381
  double sum = 0.0;
  for (auto c = kArcSine.rbegin(); c != kArcSine.rend(); ++c) sum = sum * q + *c;
  return 4.0 * x * sum;
}

/// The angle above the horizontal of a line that rises by `rise` over `way` > 0: the arc tangent of their ratio.
/// Error: below 8 ulp: up to 1.9 of the ratio besides.
inline double angle_of_rise(double rise, double way) {
  const double slant = std::sqrt(rise * rise + way * way), up = std::abs(rise);
  return std::copysign(up <= way ? arc_sine(up / slant) : 0.5 * kPi - arc_sine(way / slant), rise);
}

}  // namespace talus
