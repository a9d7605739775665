#pragma once
#include <Eigen/Core>

namespace talus {

using Vec3 = Eigen::Vector3d;  ///< x east, y north, z up; metres, m/s or rad/s

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.81;  ///< [m/s^2], downwards

constexpr double radians(double degrees) {
  return degrees * (kPi / 180.0);
}
constexpr double degrees(double radians) {
  return radians * (180.0 / kPi);
}

}  // namespace talus
