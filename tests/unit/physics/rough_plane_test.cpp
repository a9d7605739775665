#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/scenes.hpp"
#include "talus/physics/impact.hpp"

namespace talus {
namespace {

using test::Numbers;
using test::slope_normal;

double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A velocity in the vertical plane of a heading, `descent` degrees below the horizontal.
Vec3 heading_down(double azimuth, double descent, double speed = 7.0) {
  const double d = radians(descent);
  return speed * Vec3(std::cos(d) * std::cos(azimuth), std::cos(d) * std::sin(azimuth), -std::sin(d));
}

TEST(RoughPlane, DownTheSlopeTheLocalAngleMinusTheta) {  // Mitchell & Hungr, 2.1
  for (const double azimuth : {0.0, 0.7, 2.0, -1.5, kPi})
    for (const double slope : {0.0, 20.0, 38.0, 75.0})
      for (const double theta : {0.0, 5.0, 30.0, 60.0}) {
        const RoughPlane plane = rough_plane(slope_normal(slope, azimuth), heading_down(azimuth, slope + 10.0),
                                             {std::tan(radians(theta)), 0.0, 1.0, 0.3});
        EXPECT_LT((plane.normal - slope_normal(slope - theta, azimuth)).norm(), 1e-14);
        EXPECT_FALSE(plane.psi_dropped);
      }
}

TEST(RoughPlane, UpTheSlopeTheLocalAnglePlusTheta) {
  for (const double slope : {0.0, 20.0, 38.0}) {
    const RoughPlane plane = rough_plane(slope_normal(slope, 0.4), heading_down(0.4 + kPi, -0.5 * slope + 1.0),
                                         {std::tan(radians(25.0)), 0.0, 1.0, 0.3});
    EXPECT_LT((plane.normal - slope_normal(slope + 25.0, 0.4)).norm(), 1e-14);
  }
}

TEST(RoughPlane, AcrossTheSlopeTheApparentAngleMinusTheta) {
  Numbers numbers(1);
  for (int i = 0; i < 20'000; ++i) {
    const double azimuth = numbers.uniform(0, 2 * kPi), theta = radians(numbers.uniform(0, 40));
    const Vec3 n = slope_normal(numbers.uniform(0, 45), numbers.uniform(0, 2 * kPi));
    Vec3 v = heading_down(azimuth, numbers.uniform(-40, 40));
    if (v.dot(n) >= 0.0) continue;
    const Vec3 heading = v.cwiseProduct(Vec3(1, 1, 0)).normalized(), left = Vec3(0, 0, 1).cross(heading);
    const Vec3 out = rough_plane(n, v, {std::tan(theta), 0.0, 1.0, 0.0}).normal;
    if (v.dot(out) > -1e-9) continue;  // theta would turn the plane out of the way
    const auto apparent = [&](const Vec3& normal) { return std::atan2(normal.dot(heading), normal.z()); };
    ASSERT_NEAR(apparent(out), apparent(n) - theta, 1e-12);
    ASSERT_NEAR(out.dot(left), n.dot(left), 1e-14);  // tilted within the vertical plane of the motion
    ASSERT_NEAR(out.norm(), 1.0, 1e-14);
  }
}

TEST(RoughPlane, PsiTiltsSidewaysByPsiAndKeepsTheLongitudinalLine) {
  for (const double psi : {-40.0, -1.0, 3.0, 30.0})
    for (const double slope : {0.0, 30.0, 50.0}) {
      const double azimuth = 1.1, theta = 20.0;
      const Vec3 n1 = slope_normal(slope - theta, azimuth), v = heading_down(azimuth, slope + 30.0);
      const RoughPlane plane =
          rough_plane(slope_normal(slope, azimuth), v, {std::tan(radians(theta)), std::tan(radians(psi)), 1.0, 0.0});
      ASSERT_FALSE(plane.psi_dropped);
      EXPECT_NEAR(angle(plane.normal, n1), radians(std::abs(psi)), 1e-14);
      EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-15);
      const Vec3 left(-std::sin(azimuth), std::cos(azimuth), 0.0);
      EXPECT_NEAR(plane.normal.dot(left.cross(n1)), 0.0, 1e-14);  // the longitudinal tangent stays in the plane
    }
}

TEST(RoughPlane, TiltAngleIsPsiOnAnySlopeAndHeading) {
  Numbers numbers(2);
  int tilted = 0;
  for (int i = 0; i < 50'000; ++i) {
    const Vec3 n = slope_normal(numbers.uniform(0, 80), numbers.uniform(0, 2 * kPi));
    Vec3 v = numbers.vector(5.0);
    if (v.dot(n) > 0.0) v = -v;
    const Asperity a{numbers.uniform(0, 1), numbers.uniform(-1, 1), 1.0, 0.5};
    const RoughPlane plane = rough_plane(n, v, a);
    const Vec3 side = Vec3(v.y(), -v.x(), 0.0).normalized();  // heading x up: a turn about it lifts the heading
    const Vec3 n1 = Eigen::AngleAxisd(std::atan(a.tan_theta), side) * n;
    ASSERT_NEAR(plane.normal.norm(), 1.0, 1e-14);
    ASSERT_LE(v.dot(plane.normal), 1e-14 * v.norm());  // an impact, always
    if (plane.psi_dropped) {
      ASSERT_LT((plane.normal - (v.dot(n1) <= 0.0 ? n1 : n)).norm(), 1e-14);
    } else {
      ASSERT_NEAR(angle(plane.normal, n1), std::atan(std::abs(a.tan_psi)), 1e-13);
      ++tilted;
    }
  }
  EXPECT_GT(tilted, 25'000);
}

TEST(RoughPlane, PsiIsDroppedWhereItWouldTurnTheWallOutOfTheWay) {
  // A wall of 80 degrees that dips east; a block grazing it northwards. Tilting it by psi about the longitudinal
  // tangent (here north) by more than the angle of incidence turns it away on one side only.
  const Vec3 n = slope_normal(80.0, 0.0), v(-0.1, 8.0, -0.2);  // v . n = -0.133: 1 degree into the wall
  int dropped = 0;
  for (const double tan_psi : {-0.5, 0.5}) {
    const RoughPlane plane = rough_plane(n, v, {0.0, tan_psi, 1.0, 0.0});
    EXPECT_LE(v.dot(plane.normal), 0.0);
    dropped += plane.psi_dropped ? 1 : 0;
    if (plane.psi_dropped) {
      EXPECT_LT((plane.normal - n).norm(), 1e-14);
    }
  }
  EXPECT_LE(dropped, 1);
  // Oblique incidence on a steep wall: some draws must be dropped, and the fall straight down the dip never is.
  Numbers numbers(3);
  int oblique = 0, straight = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Asperity a{0.0, 0.5 * numbers.normal(), 1.0, 0.0};
    oblique += rough_plane(slope_normal(75.0, 0.0), {0.5, 3.0, -8.0}, a).psi_dropped ? 1 : 0;
    straight += rough_plane(slope_normal(75.0, 0.0), {0.5, 0.0, -8.0}, a).psi_dropped ? 1 : 0;
  }
  EXPECT_GT(oblique, 100);
  EXPECT_EQ(straight, 0);  // v . n' = cos(psi) v . n1 < 0
}

TEST(RoughPlane, AVerticalFallHeadsDownTheDip) {
  const double tan_theta = std::tan(radians(15.0));
  for (const double azimuth : {0.0, 1.0, 4.0}) {
    const Vec3 out = rough_plane(slope_normal(38.0, azimuth), {0, 0, -5}, {tan_theta, 0.0, 1.0, 0.77}).normal;
    EXPECT_LT((out - slope_normal(23.0, azimuth)).norm(), 1e-14);
    const Vec3 barely = rough_plane(slope_normal(38.0, azimuth), {1e-13, 0, -5}, {tan_theta, 0.0, 1.0, 0.77}).normal;
    EXPECT_LT((out - barely).norm(), 1e-14);  // rounding in the plan velocity is not a heading
  }
}

TEST(RoughPlane, TheNormalIsAUnitVectorHoweverSlowTheBlock) {
  for (const double speed : {1e-90, 1e-101, 1e-155, 1e-159, 1e-170}) {  // the square of 1e-159 has few digits
    const Vec3 v = speed * Vec3(1.037, -0.4998, -1.143);
    EXPECT_NEAR(rough_plane(slope_normal(40.0, 1.0), v, {0.3, 0.2, 1.0, 0.5}).normal.norm(), 1.0, 1e-14) << speed;
  }
}

TEST(RoughPlane, OnFlatGroundAVerticalFallTakesTheDrawnHeading) {
  for (const double turn : {0.0, 0.1, 0.25, 0.6, 0.99}) {
    const Vec3 out = rough_plane({0, 0, 1}, {0, 0, -5}, {std::tan(radians(15.0)), 0.0, 1.0, turn}).normal;
    EXPECT_LT((out - slope_normal(-15.0, 2 * kPi * turn)).norm(), 1e-14);
  }
}

struct Sample {
  Vec3 n, v, w;
  Asperity asperity;
};
Sample sample(Numbers& numbers) {
  Sample s{slope_normal(numbers.uniform(0, 85), numbers.uniform(0, 2 * kPi)),
           numbers.vector(8.0),
           numbers.vector(8.0),
           {numbers.uniform(0, 1.5), numbers.uniform(-1.5, 1.5), numbers.uniform(1, 1.5), 0.2}};
  if (s.v.dot(s.n) > 0.0) s.v = -s.v;
  return s;
}

TEST(ImpactSymmetry, AnyTurnOfTheSceneTurnsTheResult) {
  Numbers numbers(4);
  for (int i = 0; i < 20'000; ++i) {
    const Sample s = sample(numbers);
    const double turn = i % 4 == 0 ? 0.5 * kPi : numbers.uniform(0, 2 * kPi);
    const Eigen::Matrix3d m = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
    Motion before, turned;
    before.velocity = s.v, before.spin = s.w;
    turned.velocity = m * s.v, turned.spin = m * s.w;
    const Contact a = impact({}, {}, {1.1, 1.0}, before, s.n, s.asperity),
                  b = impact({}, {}, {1.1, 1.0}, turned, m * s.n, s.asperity);
    ASSERT_LT((rough_plane(m * s.n, m * s.v, s.asperity).normal - m * rough_plane(s.n, s.v, s.asperity).normal).norm(),
              1e-12);
    ASSERT_LT((b.velocity - m * a.velocity).norm(), 1e-12 * s.v.norm());
    ASSERT_LT((b.spin - m * a.spin).norm(), 1e-12 * (s.v.norm() + s.w.norm()));
    ASSERT_EQ(a.psi_dropped, b.psi_dropped);
  }
}

TEST(ImpactSymmetry,
     TheMirrorImageWithPsiReversedIsTheMirrorImage) {  // spin is an axial vector: it mirrors with a minus
  Numbers numbers(5);
  const Vec3 flip(-1, 1, 1);
  for (int i = 0; i < 20'000; ++i) {
    const Sample s = sample(numbers);
    Asperity reversed = s.asperity;
    reversed.tan_psi = -reversed.tan_psi;
    Motion before, mirrored;
    before.velocity = s.v, before.spin = s.w;
    mirrored.velocity = flip.cwiseProduct(s.v), mirrored.spin = -flip.cwiseProduct(s.w);
    const Contact a = impact({}, {}, {1.1, 1.0}, before, s.n, s.asperity);
    const Contact b = impact({}, {}, {1.1, 1.0}, mirrored, flip.cwiseProduct(s.n), reversed);
    ASSERT_LT((b.velocity - flip.cwiseProduct(a.velocity)).norm(), 1e-12 * s.v.norm());
    ASSERT_LT((b.spin + flip.cwiseProduct(a.spin)).norm(), 1e-12 * (s.v.norm() + s.w.norm()));
    ASSERT_EQ(a.psi_dropped, b.psi_dropped);
  }
}

}  // namespace
}  // namespace talus
