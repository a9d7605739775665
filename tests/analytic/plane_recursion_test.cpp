#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/scenes.hpp"
#include "talus/physics/trace.hpp"

namespace talus {
namespace {

// In a vertical plane (psi_scale = 0, release down the dip) 3D is 2D. This is the model of docs/physics.md, 3 to 5, in
// (x, z) on z = height - tan_b x, written anew with angles; it draws the engine's asperities, so that paths can be
// compared point by point.

constexpr double kTanB = 0.78125;  // 38 degrees, exact in floats
const Ground kFirmTalus{.theta_scale = 0.7, .shape_max = 1.5};

struct State {
  double time, x, v_x, v_z, omega;  // omega is positive where the 2D convention u = v_t + R w has it, for motion to +x
};

class Recursion {
 public:
  Recursion(std::uint32_t block, double diameter, double c, Roughness rule)
      : draws_(Random(1, 0, block, Purpose::Impact), rule), diameter_(diameter), c_(c) {}

  /// From a start `height` above the plane at x to the first contact.
  State drop(double x, double height) {
    return {std::sqrt(2 * height / kGravity), x, 0.0, -std::sqrt(2 * height * kGravity), 0.0};
  }

  State impact(State s) {
    const Asperity a = draws_.at(event_++, kFirmTalus);
    const double h = s.v_x < 0.0 ? -1.0 : 1.0, theta = std::atan(a.tan_theta), beta = std::atan(kTanB);
    // Looking along the motion: the slope falls by h beta, the rough plane by theta less.
    double fall = h * beta - theta;
    const double forward = h * s.v_x;
    if (forward * std::sin(fall) + s.v_z * std::cos(fall) > 0.0) fall = h * beta;  // theta would turn it out of the way
    const double cos = std::cos(fall), sin = std::sin(fall), arm = a.shape * 0.5 * diameter_;
    double v_t = forward * cos - s.v_z * sin, rim = h * arm * s.omega;
    const double v_n = -(forward * sin + s.v_z * cos), energy = c_ * diameter_ * v_n * v_n;
    const double k_n = 15 / (15 + energy), k_t = 50 / (50 + energy);
    const double u = k_t * (v_t + rim), limit = (1 + k_n) * v_n / std::sqrt(3.0);
    if (2.0 / 7.0 * std::abs(u) <= limit) {  // contained slip, Eq. 5
      v_t = 5.0 / 7.0 * k_t * v_t - 2.0 / 7.0 * k_t * rim;
      rim = -v_t;
    } else {  // Coulomb
      v_t = k_t * v_t - std::copysign(limit, u);
      rim = k_t * rim - 2.5 * std::copysign(limit, u);
    }
    s.v_x = h * (v_t * cos + k_n * v_n * sin);
    s.v_z = -v_t * sin + k_n * v_n * cos;
    s.omega = h * rim / arm;
    const double off = s.v_x * std::sin(beta) + s.v_z * std::cos(beta);
    if (off < 0.0) s.v_x -= off * std::sin(beta), s.v_z -= off * std::cos(beta);
    return s;
  }

  static double off_surface(const State& s) { return (s.v_x * kTanB + s.v_z) / std::hypot(1.0, kTanB); }

  static State fly(State s) {
    const double t = 2.0 * (s.v_z + kTanB * s.v_x) / kGravity;
    return {s.time + t, s.x + t * s.v_x, s.v_x, s.v_z - kGravity * t, s.omega};
  }

  /// One diameter down the slope from a speed >= 0 along it.
  State slide(State s) const {
    const double b = std::atan(kTanB), a = kGravity * (std::sin(b) - std::cos(b) / std::sqrt(3.0));
    const double v0 = s.v_x * std::cos(b) - s.v_z * std::sin(b), v = std::sqrt(v0 * v0 + 2 * a * diameter_);
    return {s.time + (v - v0) / a, s.x + diameter_ * std::cos(b), v * std::cos(b), -v * std::sin(b), s.omega};
  }

 private:
  Asperities draws_;
  std::uint32_t event_ = 0;
  double diameter_, c_;
};

/// Compares the engine's path with the recursion vertex by vertex; returns how many impacts were compared.
int compare(double c, Roughness rule, std::uint32_t block, double turn) {
  const double diameter = 1.0 + 0.004 * block;
  const bool east = turn == 0.0;
  const auto height = [&](double x, double y) { return 4096.0 - kTanB * (east ? x : 8192.0 - y); };
  const Surface surface(test::terrain(test::grid_of(128, 128, 64.0, 64.0), height));
  const Cover cover{{kFirmTalus}, {}};
  Release release;
  release.block = block;
  release.body = block_of(diameter, 2700.0);
  const double start = 100.7;
  release.motion.position = east ? Vec3(start, 3000.3, 4096.0 - kTanB * start + 2.0)
                                 : Vec3(3000.3, 8192.0 - start, 4096.0 - kTanB * start + 2.0);
  Path path;
  trace({surface, cover, {c, rule}, {}}, release, path);

  Recursion model(block, diameter, c, rule);
  State s = model.drop(start, 2.0);
  int compared = 0;
  for (const Vertex& v : path.vertices) {
    if (v.event != Event::Impact) continue;
    const Motion& m = v.motion;
    const double x = east ? m.position.x() : 8192.0 - m.position.y(), v_x = east ? m.velocity.x() : -m.velocity.y();
    const double omega = east ? -m.spin.y() : -m.spin.x();  // the axis is t x n
    s = model.impact(s);
    EXPECT_NEAR(m.time, s.time, 1e-9 * (1 + s.time)) << compared;
    EXPECT_NEAR(x, s.x, 1e-9 * s.x);
    EXPECT_NEAR(v_x, s.v_x, 1e-8);
    EXPECT_NEAR(m.velocity.z(), s.v_z, 1e-8);
    EXPECT_NEAR(omega, s.omega, 1e-7);
    EXPECT_NEAR(east ? m.position.y() : m.position.x(), 3000.3, 1e-12);  // never leaves the plane
    if (testing::Test::HasFailure()) return compared;
    ++compared;
    const double off = Recursion::off_surface(s);
    if (std::abs(off - kSlideSpeed) < 1e-6) break;
    if (off >= kSlideSpeed) {
      s = Recursion::fly(s);
      continue;
    }
    s.v_x -= off * std::sin(std::atan(kTanB)), s.v_z -= off * std::cos(std::atan(kTanB));
    if (s.v_x <= 0.0) break;  // slides up the slope: not in this recursion
    s = model.slide(s);
  }
  return compared;
}

TEST(ThreeDimensionsAreTwo, InAVerticalPlane) {
  int compared = 0;
  for (const Roughness rule : {Roughness::Clamp, Roughness::Resample})
    for (const double c : {0.25, 1.0})
      for (std::uint32_t block = 0; block < 60; ++block) {
        compared += compare(c, rule, block, block % 2 == 0 ? 0.0 : 0.25);
        if (HasFailure()) FAIL() << "block " << block << " c " << c;
      }
  EXPECT_GT(compared, 20'000);
}

}  // namespace
}  // namespace talus
