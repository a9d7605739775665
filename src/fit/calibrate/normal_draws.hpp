#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "talus/base/random.hpp"

namespace talus {

/// Uses of normal numbers that belong to no block. Each use has a stream of random numbers, its value.
enum class NormalDraw : std::uint32_t {
  Noise = 1,       ///< of a bootstrap, beyond its measured noise
  Prior = 2,       ///< of a bootstrap: the centre of the prior
  Place = 3,       ///< where a search evaluates the objective
  OpenGround = 4,  ///< a ground that the fit leaves open
};

/// Standard normal numbers of one draw.
inline Eigen::VectorXd normal_draws(std::uint64_t seed, NormalDraw what, std::uint32_t draw, Eigen::Index count) {
  const Random random(seed, static_cast<std::uint32_t>(what), draw, Purpose::Bootstrap);
  Eigen::VectorXd z(count);
  for (Eigen::Index i = 0; i < count; i += 4) {
    const Words w = random.words(static_cast<std::uint32_t>(i / 4));
    const auto a = normal_pair(w[0], w[1]), b = normal_pair(w[2], w[3]);
    const double four[] = {a[0], a[1], b[0], b[1]};
    for (Eigen::Index k = i; k < std::min(count, i + 4); ++k) z[k] = four[k - i];
  }
  return z;
}

}  // namespace talus
