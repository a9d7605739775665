#include "talus/physics/effects/soft_ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "talus/base/elementary.hpp"

namespace talus {
namespace {

/// Coefficients of asin(x)/x in powers of x^2: (2n)! / (4^n n!^2 (2n + 1)).
constexpr std::array<double, 12> kArcSine = [] {
  std::array<double, 12> series{};
  double c = 1.0;
  for (std::size_t n = 0; n < series.size(); ++n) {
    const auto k = static_cast<double>(n);
    series[n] = c / (2.0 * k + 1.0);
    c *= (2.0 * k + 1.0) / (2.0 * k + 2.0);
  }
  return series;
}();

/// asin(x) for 0 <= x <= sqrt(1/2), by its series after halving the angle twice.
double arc_sine(double x) {
  for (int halving = 0; halving < 2; ++halving) x /= std::sqrt(2.0 + 2.0 * std::sqrt(1.0 - x * x));
  const double q = x * x;  // below 0.0381
  double sum = 0.0;
  for (auto c = kArcSine.rbegin(); c != kArcSine.rend(); ++c) sum = sum * q + *c;
  return 4.0 * x * sum;
}

}  // namespace

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
