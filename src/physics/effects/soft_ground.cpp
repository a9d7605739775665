#include "talus/physics/effects/soft_ground.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/elementary.hpp"

namespace talus {
double scar_depth(const SoftGround& soft, const Block& block, double v_n) {
  if (!(v_n > 1e-6)) return 0.0;
  constexpr double kPerMega = 1e3;  // kN/m^2 in a MN/m^2
  const double depth = 0.1 * power(block.mass, 1.0 / 3.0) * power(kPerMega * soft.stiffness, -0.4) * power(v_n, 0.8);
  return std::min(depth, block.radius());
}

double segment_area(double radius, double d) {
  const double half_angle = 2.0 * arc_sine(std::sqrt(d / (2.0 * radius)));
  return radius * radius * half_angle - (radius - d) * std::sqrt(d * (2.0 * radius - d));
}

double scar_keeps(const SoftGround& soft, const Block& block, double v_n) {
  const double area = segment_area(block.radius(), scar_depth(soft, block, v_n));
  return exponential(-0.5 * soft.drag * kSoilDensity * area * soft.scar_length / block.mass);
}

}  // namespace talus
