#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "talus/base/expect.hpp"
#include "talus/base/lane.hpp"
#include "talus/base/random.hpp"
#include "talus/physics/block.hpp"
#include "talus/physics/ground.hpp"

namespace talus {

/// The impact law: docs/physics.md, "Impact", steps 1-6, in this order. Source: Mitchell & Hungr, PIERRE 2, Eqs. 1-6.
/// Each formula is a template: one block, or several in lanes (talus/base/lane.hpp).

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
template <class Number>
struct BasicAsperity {
  Number tan_theta = 0.0;  ///< longitudinal: the plane rises against the motion, >= 0 [-]
  Number tan_psi = 0.0;    ///< transverse [-]
  Number shape = 1.0;      ///< R_eff / R [-]
  Number heading = 0.0;    ///< random direction in plan [turns], [0, 1): used if neither velocity nor slope gives one
};
using Asperity = BasicAsperity<double>;

/// The random numbers of one impact: two standard normal, two uniform.
template <class Number>
struct AsperityDraw {
  Number longitudinal, transverse, shape, heading;
};
/// The draw from the four words of an impact.
template <class Word>
[[gnu::always_inline]] inline auto asperity_draw(Word first, Word second, Word third, Word fourth) {
  const auto normal = box_muller(uniform(first), uniform(second));
  return AsperityDraw<decltype(uniform(third))>{normal.first, normal.second, uniform(third), uniform(fourth)};
}
/// With Roughness::Resample a longitudinal number below this is drawn again, at most kMaxRedraws times:
/// P(N1 < -1) = 0.16 each, 200 in a row happen once in 1e160 impacts.
inline constexpr double kLowestBracket = -1.0;
inline constexpr std::uint32_t kMaxRedraws = 200;

/// Step 1 and the random shape of step 4.
template <class Number>
[[gnu::always_inline]] inline BasicAsperity<Number> asperity_of(const AsperityDraw<Number>& draw,
                                                                const BasicGround<Number>& ground) {
  return {ground.theta_scale * larger(Number(0.0), 0.5 + 0.5 * draw.longitudinal),
          ground.psi_scale * (0.5 * draw.transverse),
          ground.shape_min + (ground.shape_max - ground.shape_min) * draw.shape, draw.heading};
}

/// The asperity at each impact, a pure function of the impact's number.
/// Drawn for eight impacts at a time: the normal numbers of several impacts cost little more than those of one.
class Asperities {
 public:
  Asperities(const Random& random, Roughness rule) : random_(random), rule_(rule) {}

  /// The asperity at impact number `event`, on this ground.
  Asperity at(std::uint32_t event, const Ground& ground);

 private:
  static constexpr std::uint32_t kAhead = 8;
  void draw(std::uint32_t first_event);

  Random random_;
  Roughness rule_;
  std::uint32_t first_ = 0x80000000U;  // event of draws_[0], a multiple of kAhead; at first beyond all
  std::array<AsperityDraw<double>, kAhead> draws_;
};

/// The asperity as the model uses it: in the 2D model the random heading is east or west.
template <class Number>
[[gnu::always_inline]] inline BasicAsperity<Number> met_by(const ImpactModel& model, BasicAsperity<Number> asperity) {
  if (model.in_plane) asperity.heading = choose(asperity.heading < 0.5, Number(0.0), Number(0.5));
  return asperity;
}

/// Direction of the motion in plan. For a vertical motion or none, the dip direction; on flat ground, a random
/// direction.
template <class Number>
struct Heading {
  Number x, y;
};
template <class Number>
[[gnu::always_inline]] inline Heading<Number> heading_of(const VectorOf<Number>& velocity,
                                                         const VectorOf<Number>& normal, Number turn) {
  constexpr double kStill = 1e-100;  // a slower motion has no direction: its square has lost its digits [m/s]
  const Number plan = root(velocity.x() * velocity.x() + velocity.y() * velocity.y());
  const MaskOf<Number> moves = (plan > 1e-9 * magnitude(velocity.z())) & (plan > kStill);
  const Number per_plan = 1.0 / plan;
  if (all(moves)) return {velocity.x() * per_plan, velocity.y() * per_plan};
  const Number dip = root(normal.x() * normal.x() + normal.y() * normal.y());
  const MaskOf<Number> dips = dip > 1e-9;
  const BasicSineCosine<Number> random = sine_cosine_of_turn(turn);
  const Number x = choose(dips, normal.x() / dip, random.cosine), y = choose(dips, normal.y() / dip, random.sine);
  return {choose(moves, velocity.x() * per_plan, x), choose(moves, velocity.y() * per_plan, y)};
}

/// The plane that a block meets instead of the smooth surface.
template <class Number>
struct BasicRoughPlane {
  VectorOf<Number> normal;     ///< n', unit
  MaskOf<Number> psi_dropped;  ///< psi was left out, because with it the block would move away from the plane
};
using RoughPlane = BasicRoughPlane<double>;

/// Step 2: tilts the smooth normal by theta against the motion, then by psi about the plane's longitudinal tangent.
///
/// @param normal    of the smooth surface, unit, upwards
/// @param velocity  of the block [m/s], not pointing away from the smooth surface
template <class Number>
[[gnu::always_inline]] inline BasicRoughPlane<Number> rough_plane(const VectorOf<Number>& normal,
                                                                  const VectorOf<Number>& velocity,
                                                                  const BasicAsperity<Number>& asperity) {
  using Vector = VectorOf<Number>;
  const Heading<Number> h = heading_of<Number>(velocity, normal, asperity.heading);
  const auto to_world = [&h](Number along, Number left, Number up) {
    return Vector(along * h.x - left * h.y, along * h.y + left * h.x, up);
  };
  const Number left = normal.y() * h.x - normal.x() * h.y;
  const Number cos_theta = 1.0 / root(1.0 + asperity.tan_theta * asperity.tan_theta);
  const Number sin_theta = asperity.tan_theta * cos_theta;
  const Number level = normal.x() * h.x + normal.y() * h.y;
  const Number along = cos_theta * level - sin_theta * normal.z();
  const Number up = cos_theta * normal.z() + sin_theta * level;
  const Vector n1 = to_world(along, left, up);
  const MaskOf<Number> tilts = asperity.tan_psi != 0.0;
  // With theta alone, or on the smooth surface: a steep counter-slope, from which the block would move away.
  const auto without_psi = [&] { return choose(velocity.dot(n1) <= 0.0, n1, normal); };
  if (!any(tilts)) return {without_psi(), tilts};

  const Vector side = to_world(0.0, up, -left) * (1.0 / root(left * left + up * up));  // n1 x heading, unit
  const Number cos_psi = 1.0 / root(1.0 + asperity.tan_psi * asperity.tan_psi);
  const Vector n2 = cos_psi * Vector(n1 + asperity.tan_psi * side);
  const MaskOf<Number> meets = tilts & (velocity.dot(n2) < 0.0);
  const MaskOf<Number> misses = opposite(meets), dropped = tilts & misses;
  if (all(meets)) return {n2, misses};
  return {choose(meets, n2, without_psi()), dropped};
}
RoughPlane rough_plane(const Vec3& normal, const Vec3& velocity, const Asperity& asperity);

/// Restitution factors, the share of the momentum that is kept: E_50 / (E_d + E_50), in (0, 1].
template <class Number>
struct BasicRestitution {
  Number normal, tangential;  // k_n, k_t
};
using Restitution = BasicRestitution<double>;

/// Step 3, Eq. 3, with the deformation energy E_d = c D v_n^2 [m^3/s^2].
template <class Number>
[[gnu::always_inline]] inline BasicRestitution<Number> restitution(const BasicGround<Number>& ground,
                                                                   Number deformation_energy) {
  return {ground.En50 / (deformation_energy + ground.En50), ground.Et50 / (deformation_energy + ground.Et50)};
}

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
template <class Number>
[[gnu::always_inline]] inline Number friction_impulse(Number slip, Number impulse, Number tan_phi) {
  return smaller(2.0 / 7.0 * slip, tan_phi * impulse);
}

/// Velocity and spin after an impact.
template <class Number>
struct BasicRebound {
  VectorOf<Number> velocity, spin;
};
using Rebound = BasicRebound<double>;

/// Step 5 on a plane of normal `n`: applies the restitution factors and friction, which changes the spin.
///
/// @param arm  R_eff, distance of the contact point from the centre [m], > 0
template <class Number>
[[gnu::always_inline]] inline BasicRebound<Number> rebound(const VectorOf<Number>& velocity,
                                                           const VectorOf<Number>& spin, const VectorOf<Number>& n,
                                                           const BasicRestitution<Number>& k, Number arm,
                                                           Number tan_phi) {
  using Vector = VectorOf<Number>;
  if constexpr (std::is_same_v<Number, double>) {
    TALUS_EXPECT(std::abs(n.squaredNorm() - 1.0) < 1e-9, "the normal of a plane is a unit vector");
    TALUS_EXPECT(k.normal >= 0.0 && k.normal <= 1.0 && k.tangential >= 0.0 && k.tangential <= 1.0, "momentum is lost");
    TALUS_EXPECT(arm > 0.0, "the ground is met beside the centre");
  }
  const Number along_normal = velocity.dot(n), v_n = larger(Number(0.0), -along_normal);
  const Vector v_tan = velocity - along_normal * n;
  const Vector w_normal = spin.dot(n) * n;
  const Vector w_tan = spin - w_normal;
  const Vector u = k.tangential * Vector(v_tan - arm * w_tan.cross(n));
  const Number slip = u.norm();
  const Number impulse = (1.0 + k.normal) * v_n;
  const MaskOf<Number> slips = slip > 0.0;
  Vector friction = friction_impulse<Number>(slip, impulse, tan_phi) / slip * u;
  if (!all(slips)) friction = choose(slips, friction, Vector(Vector::Zero()));
  BasicRebound<Number> after{k.tangential * v_tan - friction + k.normal * v_n * n,
                             k.tangential * w_tan + 2.5 / arm * n.cross(friction) + w_normal};
  if constexpr (std::is_same_v<Number, double>)
    TALUS_EXPECT(after.velocity.squaredNorm() + 0.4 * arm * arm * after.spin.squaredNorm() <=
                     (1.0 + 1e-9) * (velocity.squaredNorm() + 0.4 * arm * arm * spin.squaredNorm()),
                 "energy never grows at an impact, by the law's moment of inertia");
  return after;
}
Rebound rebound(const Vec3& velocity, const Vec3& spin, const Vec3& n, const Restitution& k, double arm,
                double tan_phi);

/// Multiplies the part of a vector along the plane of normal `n` by a factor.
inline void scale_along(Vec3& vector, const Vec3& n, double factor) {
  const Vec3 across = vector.dot(n) * n;
  vector = factor * (vector - across) + across;
}

/// State of an impact between step 5 and step 6, for effects that change the rebound.
template <class Number, class Body>
struct BasicImpactMoment {
  const Body& block;
  const VectorOf<Number>&normal, &plane;  ///< of the smooth surface and of the rough plane, unit
  Number v_n;                             ///< speed into the rough plane [m/s], >= 0
  BasicRestitution<Number> k;
};
using ImpactMoment = BasicImpactMoment<double, Block>;

/// State of a block after an impact, for effects that hold it there.
struct ImpactEnd {
  const Ground& ground;
  const Block& block;
  const Vec3 &velocity, &normal;  ///< after the impact [m/s]; of the smooth surface, unit
  const Asperity& asperity;       ///< that the block has met
};

/// Changes of the law by effects: none, as in PIERRE 2.
struct NoChanges {
  [[gnu::always_inline]] static void restitution(auto& /*k*/) {}
  [[gnu::always_inline]] static void rebound(auto& /*after*/, const auto& /*moment*/) {}
};

/// Result of an impact.
template <class Number>
struct BasicContact {
  VectorOf<Number> velocity, spin;  ///< after it; the velocity never points into the smooth surface (step 6)
  MaskOf<Number> psi_dropped;
};
using Contact = BasicContact<double>;

/// The impact law: steps 2-6 on a surface of normal `normal`. The only place that combines them.
///
/// @param block    has a diameter and a radius [m]: Block
/// @param before   has a velocity and a spin: Motion
/// @param changes  of effects, with the functions of NoChanges: to the restitution after step 3, to the rebound after
///                 step 5
template <class Number, class Body, class Moving, class Changes>
[[gnu::always_inline]] inline BasicContact<Number> impact(const ImpactModel& model, const BasicGround<Number>& ground,
                                                          const Body& block, const Moving& before,
                                                          const VectorOf<Number>& normal,
                                                          const BasicAsperity<Number>& asperity, Changes&& changes) {
  const auto plane = rough_plane<Number>(normal, before.velocity, met_by(model, asperity));  // step 2
  const Number v_n = larger(Number(0.0), -before.velocity.dot(plane.normal));                // step 3
  auto k = restitution<Number>(ground, model.deformation_coefficient * block.diameter * v_n * v_n);
  changes.restitution(k);
  const Number arm = asperity.shape * block.radius();                                                // step 4
  auto after = rebound<Number>(before.velocity, before.spin, plane.normal, k, arm, ground.tan_phi);  // step 5
  changes.rebound(after, BasicImpactMoment<Number, Body>{block, normal, plane.normal, v_n, k});
  const Number into_slope = smaller(Number(0.0), after.velocity.dot(normal));  // step 6
  return {after.velocity - into_slope * normal, after.spin, plane.psi_dropped};
}

/// The impact law without effects.
Contact impact(const ImpactModel& model, const Ground& ground, const Block& block, const Motion& before,
               const Vec3& normal, const Asperity& asperity);

}  // namespace talus
