#pragma once
#include <cmath>

#include "talus/base/vector.hpp"

namespace talus {

/// A sphere of constant mass. docs/physics.md, "Block".
struct Block {
  double diameter = 1.0;     ///< equivalent diameter D = (6 m / (pi rho))^(1/3) [m]
  double mass = 1.0;         ///< [kg]
  Vec3 axes = Vec3::Ones();  ///< L1 >= L2 >= L3, in any unit; only effects use them

  double radius() const { return 0.5 * diameter; }
  double inertia() const { return 0.4 * mass * radius() * radius(); }  ///< [kg m^2]
  /// Energy of the rotation, 1/2 I w^2 [kJ]. @param spin  w, angular velocity [rad/s]
  double rotational_energy_kj(double spin) const { return 0.5e-3 * inertia() * spin * spin; }
};

/// Translational kinetic energy, 1/2 m v^2 [kJ]. @param mass  [kg] @param speed  [m/s]
inline double kinetic_energy_kj(double mass, double speed) {
  return 0.5e-3 * mass * speed * speed;
}

/// A block from its equivalent diameter [m] and its density [kg/m^3].
inline Block block_of(double diameter, double density) {
  return {diameter, density * (kPi / 6.0) * diameter * diameter * diameter, Vec3::Ones()};
}

/// Diameter of the sphere of a volume [m]. @param volume  [m^3]
inline double diameter_of(double volume) {
  return std::cbrt(6.0 / kPi * volume);
}

/// Position and motion of a block.
struct Motion {
  double time = 0.0;             ///< since the release [s]
  Vec3 position = Vec3::Zero();  ///< of the centre, treated as a point on or above the terrain [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Vec3 spin = Vec3::Zero();      ///< angular velocity [rad/s]
};

/// Largest number of pieces that break off one block, including the pieces of its pieces.
inline constexpr std::uint32_t kMostPieces = 16;

/// The start of a block: with the world, it determines the whole path.
struct Release {
  std::uint64_t seed = 1;
  std::uint32_t source = 0, block = 0;  ///< with the seed, the key of every random number on the path
  Block body;
  Motion motion;                            ///< at time 0
  int day = 0;                              ///< of the release, for effects that depend on the day
  std::uint32_t piece = 0;                  ///< 0: the block itself; else the number of its piece; part of the key
  std::uint32_t pieces_left = kMostPieces;  ///< number that may still break off; at 0 it breaks no more
};

}  // namespace talus
