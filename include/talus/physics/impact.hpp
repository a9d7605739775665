#pragma once
#include <algorithm>

#include "talus/base/random.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/ground.hpp"

namespace talus {

/// The impact law: docs/physics.md, "Impact", steps 1-6, in this order. Source: Mitchell & Hungr, PIERRE 2, Eqs. 1-6.

/// Rule for a negative roughness angle, which the paper does not allow.
enum class Roughness {
  Clamp,    ///< set it to zero (default)
  Resample  ///< draw again: the true truncated normal distribution
};

/// The settings of the impact law that hold for the whole run.
struct ImpactModel {
  double deformation_coefficient = 0.25;  ///< c in E_d = c D v_n^2 [-]
  Roughness roughness = Roughness::Clamp;
  bool in_plane = false;  ///< the 2D model: a random heading is east or west, so that y never changes
};

/// The random part of one impact.
struct Asperity {
  double tan_theta = 0.0;  ///< longitudinal: the plane rises against the motion, >= 0 [-]
  double tan_psi = 0.0;    ///< transverse [-]
  double shape = 1.0;      ///< R_eff / R [-]
  double heading = 0.0;    ///< random direction in plan [turns], [0, 1): used if neither velocity nor slope gives one
};

/// Step 1 and the random shape of step 4: the asperity at each impact, a pure function of the impact's number.
/// Drawn for eight impacts at a time: the normal numbers of several impacts cost little more than those of one.
class Asperities {
 public:
  Asperities(const Random& random, Roughness rule) : random_(random), rule_(rule) {}

  /// The asperity at impact number `event`, on this ground.
  Asperity at(std::uint32_t event, const Ground& ground);

 private:
  static constexpr std::uint32_t kAhead = 8;
  void draw(std::uint32_t first_event);

  struct Draw {
    double longitudinal, transverse, shape, heading;  // two standard normals, two uniforms
  };
  Random random_;
  Roughness rule_;
  std::uint32_t first_ = 0x80000000U;  // event of draws_[0], a multiple of kAhead; at first beyond all
  std::array<Draw, kAhead> draws_;
};

/// The asperity as the model uses it: in the 2D model the random heading is east or west.
inline Asperity met_by(const ImpactModel& model, Asperity asperity) {
  if (model.in_plane) asperity.heading = asperity.heading < 0.5 ? 0.0 : 0.5;
  return asperity;
}

/// The plane that a block meets instead of the smooth surface.
struct RoughPlane {
  Vec3 normal;       ///< n', unit
  bool psi_dropped;  ///< psi was left out, because with it the block would move away from the plane
};

/// Step 2: tilts the smooth normal by theta against the motion, then by psi about the plane's longitudinal tangent.
///
/// @param normal    of the smooth surface, unit, upwards
/// @param velocity  of the block [m/s], not pointing away from the smooth surface
RoughPlane rough_plane(const Vec3& normal, const Vec3& velocity, const Asperity& asperity);

/// Restitution factors, the share of the momentum that is kept: E_50 / (E_d + E_50), in (0, 1].
struct Restitution {
  double normal, tangential;  // k_n, k_t
};

/// Step 3, Eq. 3, with the deformation energy E_d = c D v_n^2 [m^3/s^2].
Restitution restitution(const Ground& ground, double deformation_energy);

/// Friction impulse on a sphere at an impact: it stops the slip, or reaches the Coulomb limit (step 5, Eqs. 4-6).
///
///   J = min(2/7 |u|, tan(phi) P)
///
/// @param slip     |u|, speed of the contact point over the ground [m/s], >= 0
/// @param impulse  P = (1 + k_n) v_n, normal impulse per mass [m/s], >= 0
/// @param tan_phi  tangent of the friction angle [-], >= 0
/// @return         J per mass [m/s]: the centre loses J against the slip, the rim speed 5/2 J
///
/// Error: 2 eps J. NaN slip gives NaN. Never throws.
double friction_impulse(double slip, double impulse, double tan_phi);

/// Velocity and spin after an impact.
struct Rebound {
  Vec3 velocity, spin;
};

/// Step 5 on a plane of normal `n`: applies the restitution factors and friction, which changes the spin.
///
/// @param arm  R_eff, distance of the contact point from the centre [m], > 0
Rebound rebound(const Vec3& velocity, const Vec3& spin, const Vec3& n, const Restitution& k, double arm,
                double tan_phi);

/// Multiplies the part of a vector along the plane of normal `n` by a factor.
inline void scale_along(Vec3& vector, const Vec3& n, double factor) {
  const Vec3 across = vector.dot(n) * n;
  vector = factor * (vector - across) + across;
}

/// State of an impact between step 5 and step 6, for effects that change the rebound.
struct ImpactMoment {
  const Block& block;
  const Vec3 &normal, &plane;  ///< of the smooth surface and of the rough plane, unit
  double v_n;                  ///< speed into the rough plane [m/s], >= 0
  Restitution k;
};

/// State of a block after an impact, for effects that hold it there.
struct ImpactEnd {
  const Ground& ground;
  const Block& block;
  const Vec3 &velocity, &normal;  ///< after the impact [m/s]; of the smooth surface, unit
  const Asperity& asperity;       ///< that the block has met
};

/// Changes of the law by effects: none, as in PIERRE 2.
struct NoChanges {
  static void restitution(Restitution& /*k*/) {}
  static void rebound(Rebound& /*after*/, const ImpactMoment& /*moment*/) {}
};

/// Result of an impact.
struct Contact {
  Vec3 velocity, spin;  ///< after it; the velocity never points into the smooth surface (step 6)
  bool psi_dropped;
};

/// The impact law: steps 2-6 on a surface of normal `normal`. The only place that combines them.
///
/// @param changes  of effects, with the functions of NoChanges: to the restitution after step 3, to the rebound after
///                 step 5
template <class Changes>
Contact impact(const ImpactModel& model, const Ground& ground, const Block& block, const Motion& before,
               const Vec3& normal, const Asperity& asperity, Changes&& changes) {
  const RoughPlane plane = rough_plane(normal, before.velocity, met_by(model, asperity));  // step 2
  const double v_n = std::max(0.0, -before.velocity.dot(plane.normal));                    // step 3
  Restitution k = restitution(ground, model.deformation_coefficient * block.diameter * v_n * v_n);
  changes.restitution(k);
  const double arm = asperity.shape * block.radius();                                           // step 4
  Rebound after = rebound(before.velocity, before.spin, plane.normal, k, arm, ground.tan_phi);  // step 5
  changes.rebound(after, ImpactMoment{block, normal, plane.normal, v_n, k});
  const double into_slope = std::min(0.0, after.velocity.dot(normal));  // step 6
  return {after.velocity - into_slope * normal, after.spin, plane.psi_dropped};
}

/// The impact law without effects.
Contact impact(const ImpactModel& model, const Ground& ground, const Block& block, const Motion& before,
               const Vec3& normal, const Asperity& asperity);

}  // namespace talus
