#include "talus/physics/impact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "talus/base/elementary.hpp"
#include "talus/base/expect.hpp"

namespace talus {
namespace {

constexpr std::uint32_t kMaxRedraws = 200;  // P(N1 < -1) = 0.16 each: 200 in a row happen once in 1e160 impacts
constexpr double kStill = 1e-100;           // a slower motion has no direction: its square has lost its digits [m/s]

/// Direction of the motion in plan. For a vertical motion or none, the dip direction; on flat ground, a random
/// direction.
Eigen::Vector2d heading_of(const Vec3& velocity, const Vec3& normal, double turn) {
  const double plan = std::sqrt(velocity.x() * velocity.x() + velocity.y() * velocity.y());
  if (plan > 1e-9 * std::abs(velocity.z()) && plan > kStill) return velocity.head<2>() * (1.0 / plan);
  const double dip = std::sqrt(normal.x() * normal.x() + normal.y() * normal.y());
  if (dip > 1e-9) return {normal.x() / dip, normal.y() / dip};
  const SineCosine direction = sine_cosine_of_turn(turn);
  return {direction.cosine, direction.sine};
}

}  // namespace

void Asperities::draw(std::uint32_t first_event) {
  std::array<Words, kAhead> words;
  for (std::uint32_t i = 0; i < kAhead; ++i) words[i] = random_.words(first_event + i);
  for (std::uint32_t i = 0; i < kAhead; ++i) {
    const auto [longitudinal, transverse] = normal_pair(words[i][0], words[i][1]);
    draws_[i] = {longitudinal, transverse, uniform(words[i][2]), uniform(words[i][3])};
  }
  first_ = first_event;
}

Asperity Asperities::at(std::uint32_t event, const Ground& ground) {
  if (event - first_ >= kAhead) draw(event - event % kAhead);
  const Draw& draw = draws_[event - first_];
  double longitudinal = draw.longitudinal;
  if (rule_ == Roughness::Resample)
    for (std::uint32_t part = 1; longitudinal < -1.0 && part < kMaxRedraws; ++part) {
      const Words words = random_.words(event, part);
      longitudinal = normal_pair(words[0], words[1])[0];
    }
  return {ground.theta_scale * std::max(0.0, 0.5 + 0.5 * longitudinal), ground.psi_scale * (0.5 * draw.transverse),
          ground.shape_min + (ground.shape_max - ground.shape_min) * draw.shape, draw.heading};
}

RoughPlane rough_plane(const Vec3& normal, const Vec3& velocity, const Asperity& asperity) {
  const Eigen::Vector2d h = heading_of(velocity, normal, asperity.heading);
  const auto to_world = [&h](double along, double left, double up) {
    return Vec3(along * h.x() - left * h.y(), along * h.y() + left * h.x(), up);
  };
  const double left = normal.y() * h.x() - normal.x() * h.y();
  const double cos_theta = 1.0 / std::sqrt(1.0 + asperity.tan_theta * asperity.tan_theta);
  const double sin_theta = asperity.tan_theta * cos_theta;
  const double level = normal.x() * h.x() + normal.y() * h.y();
  const double along = cos_theta * level - sin_theta * normal.z();
  const double up = cos_theta * normal.z() + sin_theta * level;
  const Vec3 n1 = to_world(along, left, up);

  if (asperity.tan_psi != 0.0) {  // side = n1 x heading, scaled to unit length
    const Vec3 side = to_world(0.0, up, -left) * (1.0 / std::sqrt(left * left + up * up));
    const double cos_psi = 1.0 / std::sqrt(1.0 + asperity.tan_psi * asperity.tan_psi);
    const Vec3 n2 = cos_psi * (n1 + asperity.tan_psi * side);
    if (velocity.dot(n2) < 0.0) return {n2, false};
  }
  const bool psi_dropped = asperity.tan_psi != 0.0;
  if (velocity.dot(n1) <= 0.0) return {n1, psi_dropped};
  return {normal, psi_dropped};  // a steep counter-slope: with theta alone the block would move away from the plane
}

Restitution restitution(const Ground& ground, double deformation_energy) {
  return {ground.En50 / (deformation_energy + ground.En50), ground.Et50 / (deformation_energy + ground.Et50)};
}

double friction_impulse(double slip, double impulse, double tan_phi) {
  return std::min(2.0 / 7.0 * slip, tan_phi * impulse);
}

Rebound rebound(const Vec3& velocity, const Vec3& spin, const Vec3& n, const Restitution& k, double arm,
                double tan_phi) {
  TALUS_EXPECT(std::abs(n.squaredNorm() - 1.0) < 1e-9, "the normal of a plane is a unit vector");
  TALUS_EXPECT(k.normal >= 0.0 && k.normal <= 1.0 && k.tangential >= 0.0 && k.tangential <= 1.0, "momentum is lost");
  TALUS_EXPECT(arm > 0.0, "the ground is met beside the centre");
  const double along_normal = velocity.dot(n), v_n = std::max(0.0, -along_normal);
  const Vec3 v_tan = velocity - along_normal * n;
  const Vec3 w_normal = spin.dot(n) * n;
  const Vec3 w_tan = spin - w_normal;
  const Vec3 u = k.tangential * (v_tan - arm * w_tan.cross(n));
  const double slip = u.norm();
  const double impulse = (1.0 + k.normal) * v_n;
  const Vec3 friction = slip > 0.0 ? Vec3(friction_impulse(slip, impulse, tan_phi) / slip * u) : Vec3(Vec3::Zero());
  Rebound after{k.tangential * v_tan - friction + k.normal * v_n * n,
                k.tangential * w_tan + 2.5 / arm * n.cross(friction) + w_normal};
  TALUS_EXPECT(after.velocity.squaredNorm() + 0.4 * arm * arm * after.spin.squaredNorm() <=
                   (1.0 + 1e-9) * (velocity.squaredNorm() + 0.4 * arm * arm * spin.squaredNorm()),
               "energy never grows at an impact, by the law's moment of inertia");
  return after;
}

// Flattened (all calls inlined): otherwise the plain engine takes a tenth longer.
[[gnu::flatten]] Contact impact(const ImpactModel& model, const Ground& ground, const Block& block,
                                const Motion& before, const Vec3& normal, const Asperity& asperity) {
  return impact(model, ground, block, before, normal, asperity, NoChanges{});
}

}  // namespace talus
