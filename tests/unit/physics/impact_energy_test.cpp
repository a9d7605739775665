#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/scenes.hpp"
#include "talus/physics/impact.hpp"

namespace talus {
namespace {

using test::Numbers;
using test::slope_normal;

// Energy at an impact. Per mass, with W = R_eff w the rim speed of Eq. 5 and s = R_eff / R the shape:
//
//   law energy    v^2/2 + W^2/5           (moment of inertia 2/5 m R_eff^2)
//   true energy   v^2/2 + W^2/(5 s^2)     (moment of inertia 2/5 m R^2)
//
// The law energy never grows: k_n, k_t <= 1 shorten v_n, v_t and W; then an impulse J against the slip u changes it by
// -J u + 7/4 J^2 <= 0 for 0 <= J <= 4/7 u, and the law has J <= 2/7 u; step 6 removes a part of v.
// With s = 1 both are the same. With s > 1 the true one may grow. It is convex in J, so its worst case in [0, 2/7 u] is
// J = 0 (no growth) or the contained slip v' = (5 v - 2 W)/7 = -W', whose tangential energy is v'^2 (1/2 + 1/(5 s^2)).
// The largest (5 v - 2 W)^2 for v^2/2 + W^2/(5 s^2) = 1 is 50 + 20 s^2, hence
//
//   true energy after / before <= (10 s^4 + 29 s^2 + 10) / (49 s^2) = 1.1417 at s = 1.5, for any k_n, k_t, phi.
//
// With phi = 30 degrees a contained slip needs v_n >= 2/7 u / (tan(phi) (1 + k_n)), whose energy is kept at best: the
// worst case falls to 1.1352 (s = 1.5, v_t : W : v_n = 0.960 : -2.094 : 0.281, backspin at twice the speed), reached
// only as speeds go to 0 (k_n, k_t -> 1). With E_n50 = 15, c = 0.25, D = 1 m it is 1.116 at 5 m/s and 1.085 at 10 m/s
// (numerical search over all states).

constexpr double kWorstTrue = 1.1352;  // by a search over 2e6 states, refined; phi 30 degrees, s = 1.5

struct Energies {
  double law, real, translation;
};
Energies energies(const Vec3& v, const Vec3& w, double radius, double shape) {
  const double spin2 = 0.2 * radius * radius * w.squaredNorm();
  return {0.5 * v.squaredNorm() + spin2 * shape * shape, 0.5 * v.squaredNorm() + spin2, 0.5 * v.squaredNorm()};
}

struct Worst {
  double law = 0.0, real = 0.0, translation = 0.0;
  int translation_grew = 0;

  void add(const Energies& before, const Energies& after) {
    law = std::max(law, after.law / before.law);
    real = std::max(real, after.real / before.real);
    translation = std::max(translation, after.translation / before.translation);
    translation_grew += after.translation > before.translation ? 1 : 0;
  }
};

/// One impact of a state on a slope, law energy before and after.
void hit(Worst& worst, const Ground& ground, const Block& block, const Motion& before, const Vec3& n,
         const Asperity& asperity) {
  const Contact after = impact({}, ground, block, before, n, asperity);
  worst.add(energies(before.velocity, before.spin, block.radius(), asperity.shape),
            energies(after.velocity, after.spin, block.radius(), asperity.shape));
}

/// Any state that meets any slope up to 85 degrees, with any roughness.
Worst any_impacts(int count, double shape_max, std::uint64_t seed) {
  Numbers numbers(seed);
  Worst worst;
  for (int i = 0; i < count; ++i) {
    const Vec3 n = slope_normal(numbers.uniform(0, 85), numbers.uniform(0, 2 * kPi));
    const Block block = block_of(numbers.uniform(0.2, 3.0), 2700.0);
    Motion before;
    before.velocity = numbers.vector(std::pow(10.0, numbers.uniform(-2, 1.5)));
    if (before.velocity.dot(n) > 0.0) before.velocity = -before.velocity;
    before.spin = numbers.vector(2.0 * before.velocity.norm() / block.radius());
    if (i % 4 == 0)
      before.spin = -before.velocity.norm() / block.radius() * numbers.uniform(-4, 4) * n.unitOrthogonal();
    const Asperity a{std::abs(numbers.normal()), numbers.normal(), numbers.uniform(1.0, shape_max),
                     numbers.uniform(0, 1)};
    hit(worst, {}, block, before, n, a);
  }
  return worst;
}

TEST(ImpactEnergy, NeverGrowsForASphere) {
  EXPECT_LE(any_impacts(1'000'000, 1.0, 1).real, 1.0 + 16 * test::kEps);
}

TEST(ImpactEnergy, WithAShapeTheLawEnergyNeverGrowsAndTheTrueOneIsBounded) {
  const Worst worst = any_impacts(1'000'000, 1.5, 2);
  EXPECT_LE(worst.law, 1.0 + 16 * test::kEps);
  EXPECT_LE(worst.real, kWorstTrue);
  EXPECT_GT(worst.real, 1.02) << "the sample is too tame to test the bound";
  RecordProperty("worst_true_ratio", std::to_string(worst.real));
}

TEST(ImpactEnergy, TheWorstCaseOfTheTrueEnergyIsAsDerived) {  // slowly: k_n, k_t -> 1
  const double shape = 1.5, radius = 0.5, speed = 1e-3;
  const Vec3 v = speed * Vec3(0.9598, 0, -0.2807);
  Motion before;
  before.velocity = v;
  before.spin = Vec3(0, speed * 2.0943 / (shape * radius), 0);  // +y rolls towards +x: W = -2.0943
  const Contact after = impact({}, {}, {2 * radius, 1.0}, before, {0, 0, 1}, {0, 0, shape, 0});
  const double ratio =
      energies(after.velocity, after.spin, radius, shape).real / energies(v, before.spin, radius, shape).real;
  EXPECT_NEAR(ratio, 1.135193, 3e-5);  // four digits of the state
  EXPECT_LT(ratio, (10 * std::pow(shape, 4) + 29 * shape * shape + 10) / (49 * shape * shape));
}

/// A block that falls along a 75 degree wall with the roughness of upper-talus-3d, its spin anywhere between none and
/// rolling.
Worst wall_impacts(double shape_max) {
  const Ground upper_talus{.theta_scale = 1.0, .psi_scale = 0.9, .En50 = 15.0, .Et50 = 50.0, .shape_max = shape_max};
  const Vec3 n = slope_normal(75.0, 0.3);
  Numbers numbers(3);
  Worst worst;
  for (std::uint32_t i = 0; i < 300'000; ++i) {
    const Block block = block_of(numbers.uniform(0.3, 2.0), 2700.0);
    Motion before;
    const double speed = numbers.uniform(1.0, 40.0);
    before.velocity = speed * Vec3(numbers.uniform(-0.3, 0.6), numbers.uniform(-0.4, 0.4), -1.0);
    if (before.velocity.dot(n) >= 0.0) continue;
    before.spin = numbers.uniform(0, 1) * n.cross(before.velocity) / block.radius();
    hit(worst, upper_talus, block, before, n,
        Asperities(Random(4, 0, i, Purpose::Impact), Roughness::Clamp).at(0, upper_talus));
  }
  return worst;
}

TEST(ImpactEnergy, NoneIsGainedAtAWallOf75Degrees) {
  const Worst sphere = wall_impacts(1.0);
  EXPECT_LE(sphere.real, 1.0 + 16 * test::kEps);
  EXPECT_LE(sphere.translation, 1.4);  // spin feeds speed, at most all of it: 2/5 of v^2 for a rolling sphere
  RecordProperty("translation_grew", sphere.translation_grew);
  RecordProperty("translation_worst", std::to_string(sphere.translation));
  const Worst shaped = wall_impacts(1.5);
  EXPECT_LE(shaped.law, 1.0 + 16 * test::kEps);
  EXPECT_LE(shaped.real, kWorstTrue);
  RecordProperty("translation_worst_with_shape", std::to_string(shaped.translation));
  RecordProperty("true_worst_with_shape", std::to_string(shaped.real));
}

TEST(ImpactEnergy, SpinThatIsNotTouchedIsNotLost) {  // spin about the normal of the rough plane enters on both sides
  Motion before;
  before.velocity = {0, 0, -3};
  before.spin = {0, 0, 5};
  const Contact after = impact({}, {}, {1.0, 1.0}, before, {0, 0, 1}, {0, 0, 1, 0});
  EXPECT_EQ(after.spin.z(), 5.0);
}

}  // namespace
}  // namespace talus
