#pragma once
#include "talus/base/vector.hpp"

namespace talus {

/// A sphere of constant mass. docs/physics.md, "Block".
struct Block {
  double diameter = 1.0;     ///< equivalent diameter D = (6 m / (pi rho))^(1/3) [m]
  double mass = 1.0;         ///< [kg]
  Vec3 axes = Vec3::Ones();  ///< L1 >= L2 >= L3, in any unit: for effects that need a shape

  double radius() const { return 0.5 * diameter; }
  double inertia() const { return 0.4 * mass * radius() * radius(); }  ///< [kg m^2]
};

/// The block of an equivalent diameter [m] and a density [kg/m^3].
inline Block block_of(double diameter, double density) {
  return {diameter, density * (kPi / 6.0) * diameter * diameter * diameter, Vec3::Ones()};
}

/// Where a block is and how it moves.
struct Motion {
  double time = 0.0;             ///< since the release [s]
  Vec3 position = Vec3::Zero();  ///< of the centre, treated as a point on or above the terrain [m]
  Vec3 velocity = Vec3::Zero();  ///< [m/s]
  Vec3 spin = Vec3::Zero();      ///< angular velocity [rad/s]
};

/// Most pieces that break off one block, those of its pieces counted.
inline constexpr std::uint32_t kMostPieces = 16;

/// A block about to go: all that decides its path, beside the world.
struct Release {
  std::uint64_t seed = 1;
  std::uint32_t source = 0, block = 0;  ///< with the seed, the key of every random number on the path
  Block body;
  Motion motion;                            ///< at time 0
  int day = 0;                              ///< of the release, for effects that change with it
  std::uint32_t piece = 0;                  ///< 0: the block itself; else which of its pieces, part of the key
  std::uint32_t pieces_left = kMostPieces;  ///< how many more may break off; with none left it breaks no more
};

}  // namespace talus
