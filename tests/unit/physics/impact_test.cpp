#include "talus/physics/impact.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <sstream>

#include "support/scenes.hpp"

#ifndef TALUS_TEST_CASES
#define TALUS_TEST_CASES TALUS_SOURCE_DIR "/tests/cases"
#endif

namespace talus {
namespace {

using test::kEps;
using test::kTan30;
using test::Numbers;

/// Motion along the direction t of a plane of normal n: the quantities of the two-dimensional equations.
struct Flat {
  double v_t, rim;
};

/// The 2D convention is u = v_t + R w; in space u = v - R w x n. With w = (rim / R) a, u along t wants -a x n = t: a =
/// t x n.
Flat rebound_2d(double v_t, double rim, double v_n, const Restitution& k, double tan_phi, const Vec3& t,
                const Vec3& n) {
  const double arm = 0.37;
  const Vec3 axis = t.cross(n);
  const Rebound after = rebound(v_t * t - v_n * n, rim / arm * axis, n, k, arm, tan_phi);
  EXPECT_NEAR(after.velocity.dot(n), k.normal * v_n, 1e-12 * (1.0 + v_n));
  EXPECT_NEAR(after.velocity.dot(axis), 0.0, 1e-12 * (1.0 + std::abs(v_t)));  // stays in the plane of the motion
  EXPECT_NEAR(after.spin.cross(axis).norm(), 0.0, 1e-12 * (1.0 + std::abs(rim)) / arm);
  return {after.velocity.dot(t), arm * after.spin.dot(axis)};
}

struct Case {
  double v_t, rim, v_n, k_n, k_t, phi, v_t_out, rim_out, tolerance;
  std::string source;
};

std::vector<Case> read_cases(const std::string& path) {
  std::ifstream file(path);
  std::vector<Case> cases;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#' || line.starts_with("v_t")) continue;
    std::istringstream fields(line);
    Case c;
    char comma = 0;
    for (double* x : {&c.v_t, &c.rim, &c.v_n, &c.k_n, &c.k_t, &c.phi, &c.v_t_out, &c.rim_out, &c.tolerance})
      fields >> *x >> comma;
    EXPECT_TRUE(fields) << path << ": cannot read: " << line;
    std::getline(fields, c.source);
    cases.push_back(c);
  }
  return cases;
}

TEST(Rebound, PublishedVectors) {
  const auto cases = read_cases(TALUS_TEST_CASES "/impact.csv");
  ASSERT_GE(cases.size(), 5U) << TALUS_TEST_CASES "/impact.csv";
  for (const Case& c : cases)
    for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0)}) {
      const Vec3 t = n.cross(Vec3(0.28, 0.96, 0)).normalized();
      for (const Vec3& along : {t, Vec3(-t)}) {  // the other way round is the same impact
        const Flat out = rebound_2d(c.v_t, c.rim, c.v_n, {c.k_n, c.k_t}, std::tan(radians(c.phi)), along, n);
        EXPECT_NEAR(out.v_t, c.v_t_out, c.tolerance) << c.source;
        EXPECT_NEAR(out.rim, c.rim_out, c.tolerance) << c.source;
      }
    }
}

TEST(Rebound, TheTwoBranchesMeetAtTheSwitch) {  // 2/7 u = tan(phi) P, and an ulp-sized step to both sides of it
  const double v_n = 3.0, k_n = 0.4, impulse = (1.0 + k_n) * v_n, u = 3.5 * kTan30 * impulse;
  for (const double rim : {-6.0, 0.0, 4.0}) {
    const Vec3 t(1, 0, 0), n(0, 0, 1);
    const Flat below = rebound_2d((u - rim) * (1 - 1e-9), rim, v_n, {k_n, 1.0}, kTan30, t, n);
    const Flat above = rebound_2d((u - rim) * (1 + 1e-9), rim, v_n, {k_n, 1.0}, kTan30, t, n);
    EXPECT_NEAR(below.v_t, above.v_t, 1e-7);
    EXPECT_NEAR(below.rim, above.rim, 1e-7);
    EXPECT_NEAR(below.v_t + below.rim, 0.0, 1e-12);  // contained: the contact point ends at rest
    EXPECT_NEAR(above.v_t + above.rim, 0.0, 1e-7);
  }
}

TEST(Rebound, SpinAboutTheNormalIsKeptAndActsOnNothing) {
  Numbers numbers(1);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3 n = numbers.vector(1.0).normalized(), v = numbers.vector(10.0), w = numbers.vector(10.0);
    const double extra = numbers.uniform(-50, 50);
    const Rebound one = rebound(v, w, n, {0.4, 0.7}, 0.6, kTan30),
                  two = rebound(v, w + extra * n, n, {0.4, 0.7}, 0.6, kTan30);
    ASSERT_NEAR(one.spin.dot(n), w.dot(n), 1e-13 * w.norm());
    ASSERT_LT((two.velocity - one.velocity).norm(), 1e-12);
    ASSERT_LT((two.spin - one.spin - extra * n).norm(), 1e-12);
  }
}

/// About the contact point neither friction nor the normal impulse has a moment: only k_t changes 2/5 R^2 w + R n x v.
TEST(Rebound, FrictionKeepsTheAngularMomentumAboutTheContact) {
  Numbers numbers(2);
  for (int i = 0; i < 10'000; ++i) {
    const double arm = numbers.uniform(0.1, 3.0), k_t = numbers.uniform(0.0, 1.0);
    const Vec3 n = numbers.vector(1.0).normalized(), v = numbers.vector(10.0), w = numbers.vector(10.0 / arm);
    const auto momentum = [&](const Vec3& velocity, const Vec3& spin) {
      return Vec3(0.4 * arm * arm * (spin - spin.dot(n) * n) + arm * n.cross(velocity));
    };
    const Rebound out = rebound(v, w, n, {0.3, k_t}, arm, numbers.uniform(0.0, 2.0));
    ASSERT_LT((momentum(out.velocity, out.spin) - k_t * momentum(v, w)).norm(), 1e-11 * arm);
  }
}

TEST(Rebound, FrictionActsAgainstTheSlipAndNeverTurnsItRound) {
  Numbers numbers(3);
  for (int i = 0; i < 10'000; ++i) {
    const double arm = numbers.uniform(0.1, 3.0), tan_phi = numbers.uniform(0.0, 1.0);
    const Vec3 n = numbers.vector(1.0).normalized(), w = numbers.vector(10.0 / arm);
    Vec3 v = numbers.vector(10.0);
    if (v.dot(n) > 0.0) v = -v;
    const auto slip = [&](const Vec3& velocity, const Vec3& spin) {  // velocity of the contact point, by its definition
      const Vec3 point = velocity + spin.cross(Vec3(-arm * n));
      return Vec3(point - point.dot(n) * n);
    };
    const Rebound out = rebound(v, w, n, {0.3, 1.0}, arm, tan_phi);
    const Vec3 before = slip(v, w), after = slip(out.velocity, out.spin);
    ASSERT_LE(after.norm(), before.norm() * (1 + 1e-12));
    ASSERT_GE(after.dot(before), -1e-11);
    ASSERT_LT(after.cross(before).norm(), 1e-10 * before.squaredNorm());
    const Vec3 friction = out.velocity - v + (1.3 * v.dot(n)) * n;  // what is left of the impulse, per mass
    ASSERT_LE(friction.norm(), tan_phi * 1.3 * -v.dot(n) + 1e-12);  // Coulomb
  }
}

TEST(FrictionImpulse, ContainedSlipLeavesTheContactAtRest) {
  for (const double slip : {0.0, 1e-9, 7.0, 60.0}) {
    const double j = friction_impulse(slip, 1e3, kTan30);
    EXPECT_NEAR(slip - j - 2.5 * j, 0.0, 4 * kEps * slip);  // centre and rim: 1 + 5/2 = 7/2
  }
}

TEST(FrictionImpulse, CoulombLimit) {
  EXPECT_NEAR(friction_impulse(15.0, 2.6, kTan30), 1.501110700, 1e-9);
}

TEST(FrictionImpulse, NoFrictionNoImpulseNoSlip) {
  EXPECT_EQ(friction_impulse(10.0, 5.0, 0.0), 0.0);
  EXPECT_EQ(friction_impulse(10.0, 0.0, kTan30), 0.0);
  EXPECT_EQ(friction_impulse(0.0, 5.0, kTan30), 0.0);
}

TEST(FrictionImpulse, NaNSlipGivesNaN) {
  EXPECT_TRUE(std::isnan(friction_impulse(std::nan(""), 5.0, kTan30)));
}

TEST(FrictionImpulse, NeverGainsEnergy) {
  const auto energy = [](double v, double rim) { return v * v + 0.4 * rim * rim; };  // twice, per mass
  for (const double v : {-2.0, 0.0, 30.0})
    for (const double rim : {-40.0, -3.0, 0.0, 25.0}) {
      const double u = v + rim, j = std::copysign(friction_impulse(std::abs(u), 5.2, kTan30), u);
      EXPECT_LE(energy(v - j, rim - 2.5 * j), energy(v, rim) * (1 + 16 * kEps)) << v << ' ' << rim;
    }
}

TEST(Restitution, OneAtRestHalfAtE50AndAHyperbola) {
  const Ground ground{.En50 = 15.0, .Et50 = 50.0};
  EXPECT_EQ(restitution(ground, 0.0).normal, 1.0);
  EXPECT_EQ(restitution(ground, 0.0).tangential, 1.0);
  EXPECT_EQ(restitution(ground, 15.0).normal, 0.5);
  EXPECT_EQ(restitution(ground, 50.0).tangential, 0.5);
  EXPECT_NEAR(restitution(ground, 30.0).normal, 1.0 / 3.0, 2 * kEps);  // twice E_50 keeps a third
  EXPECT_NEAR(restitution(ground, 150.0).tangential, 0.25, 2 * kEps);  // three times, a quarter
}

TEST(Impact, DeformationEnergyIsCTimesDTimesVnSquared) {  // k_n = 1/2 where c D v_n^2 = E_n50
  const Ground ground{.En50 = 15.0, .Et50 = 50.0};
  for (const double c : {0.25, 1.0})
    for (const double diameter : {0.3, 1.2}) {
      const double v_n = std::sqrt(15.0 / (c * diameter));
      Motion before;
      before.velocity = Vec3(0, 0, -v_n);
      const Contact out = impact({c, Roughness::Clamp}, ground, {diameter, 1.0}, before, Vec3(0, 0, 1), {0, 0, 1.4, 0});
      EXPECT_NEAR(out.velocity.z(), 0.5 * v_n, 1e-14 * v_n);  // whatever the shape: D is the equivalent diameter
    }
}

TEST(Impact, TheArmIsTheShapeTimesTheRadius) {  // 5/7 and W' = -v': the spin of a contained impact shows the arm
  Motion before;
  before.velocity = Vec3(7, 0, -20);
  for (const double shape : {1.0, 1.25, 1.5}) {
    const Contact out = impact({0.0, Roughness::Clamp}, {}, {1.6, 1.0}, before, Vec3(0, 0, 1), {0, 0, shape, 0});
    EXPECT_NEAR(out.velocity.x(), 5.0, 1e-13);
    EXPECT_NEAR(out.spin.y(), 5.0 / (0.8 * shape), 1e-13);  // rolls forwards: about +y for a motion towards +x
  }
}

TEST(Impact, NeverIntoTheSmoothSlope) {
  Numbers numbers(4);
  int removed = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Vec3 n = test::slope_normal(numbers.uniform(0, 85), numbers.uniform(0, 2 * kPi));
    Motion before;
    before.velocity = numbers.vector(10.0);
    if (before.velocity.dot(n) > 0.0) before.velocity = -before.velocity;
    before.spin = numbers.vector(10.0);
    const Contact out =
        impact({}, {.En50 = 5.0}, {1.0, 1.0}, before, n, {numbers.uniform(0, 3), numbers.uniform(-2, 2), 1.0, 0.1});
    ASSERT_GE(out.velocity.dot(n), -1e-13 * before.velocity.norm());
    removed += std::abs(out.velocity.dot(n)) < 1e-13 * before.velocity.norm() ? 1 : 0;
  }
  EXPECT_GT(removed, 1000);  // the rule was needed
}

}  // namespace
}  // namespace talus
