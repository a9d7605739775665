#pragma once
#include <cmath>

#include "talus/base/random.hpp"

namespace talus {

/// A gamma distributed number of scale 1, by rejection of 5 % of the proposals at most. Made of our own elementary
/// functions: the same bits on every machine.
///
/// @param event  of the stream
/// @param shape  >= 1
/// Source: Marsaglia & Tsang (2000), "A simple method for generating gamma variables".
inline double gamma_draw(const Random& random, std::uint32_t event, double shape) {
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  for (std::uint32_t part = 0; part < 256; ++part) {
    const Words words = random.words(event, part);
    const double x = normal_pair(words[0], words[1])[0];
    const double base = 1.0 + c * x;
    if (!(base > 0.0)) continue;
    const double v = base * base * base;
    if (natural_log(uniform(words[2])) < 0.5 * x * x + d * (1.0 - v + natural_log(v))) return d * v;
  }
  return d;  // after 256 rejections in a row: never
}

/// A beta distributed number. Takes the events 0 and 1 of the stream.
///
/// @param a, b  >= 1
inline double beta_draw(const Random& random, double a, double b) {
  const double x = gamma_draw(random, 0, a), y = gamma_draw(random, 1, b);
  return x / (x + y);
}

}  // namespace talus
