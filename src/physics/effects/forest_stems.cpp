#include "talus/physics/effects/forest_stems.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

double stem_capacity(const ForestStems& forest) {
  return forest.species_factor * 38.7 * power(100.0 * forest.diameter, 2.31);
}

double stem_share(double eccentricity) {
  constexpr double kLn10 = 2.302585092994046;
  const double away = exponential(kLn10 * -8.007 * (0.58 - std::abs(eccentricity)));
  return std::max(0.0, -0.046 + 1.026 / (1.0 + away));
}

Vec3 velocity_after_stem(const Vec3& velocity, double taken, double eccentricity) {
  const double speed_squared = velocity.squaredNorm();
  if (!(speed_squared > 0.0)) return velocity;
  const double left = std::max(0.0, 1.0 - 2.0 * taken / speed_squared);  // share of v^2
  const double across = eccentricity, towards = std::sqrt(1.0 - across * across);
  const double towards_after = std::sqrt(std::max(0.0, towards * towards - (1.0 - left)));
  const double length = std::sqrt(across * across + towards_after * towards_after);
  if (!(length > 0.0)) return Vec3::Zero();
  // Angle between the directions (towards, across) before and (towards_after, across) after.
  const double cosine = (towards * towards_after + across * across) / length;
  const double sine = across * (towards - towards_after) / length;
  const double kept = std::sqrt(left);
  return {kept * (cosine * velocity.x() + sine * velocity.y()), kept * (cosine * velocity.y() - sine * velocity.x()),
          kept * velocity.z()};
}

Stems::Stems(const ForestStems& forest, const Random& random)
    : forest_(forest), random_(random), capacity_(stem_capacity(forest)) {
  draw();
}

void Stems::draw() {
  const Words words = random_.words(number_++);
  left_ = -natural_log(uniform(words[0]));
  eccentricity_ = 2.0 * uniform(words[1]) - 1.0;
}

bool Stems::go(double way, double diameter) {
  left_ -= way / mean_way_between_stems(forest_, diameter);
  return left_ <= 1e-9;  // a piece that ends at the stem may fall short of it by rounding
}

Vec3 Stems::hit(const Vec3& velocity, double mass) {
  const double capacity = capacity_ * stem_share(eccentricity_) / mass;
  Vec3 after = velocity_after_stem(velocity, std::min(0.5 * velocity.squaredNorm(), capacity), eccentricity_);
  draw();
  return after;
}

}  // namespace talus
