#pragma once
#include "talus/base/random.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/path.hpp"

namespace talus {

/// A block that breaks at a hard impact.
struct Fragmentation {
  double threshold = 0.0;  ///< energy lost across the plane, per mass, above which it breaks [J/kg]; 0: never
  double largest = 0.5;    ///< share of the mass that the largest piece keeps, in [1/2, 1)
  EffectArea where;
};

/// fragmentation. docs/effects.md, "fragmentation".

inline constexpr int kPiecesAtOnce = 4;        ///< most pieces that break off at one impact
inline constexpr double kSmallestPiece = 1.0;  ///< [kg]: what would be smaller stays with its neighbour
inline constexpr double kConeAngle = 50.0;     ///< opening of the cone in which pieces fly, side to side [deg]
inline constexpr double kBreakKeeps = 0.99;    ///< share of the kinetic energy that is left

/// Energy lost across the plane of an impact, per mass [J/kg]: 1/2 v_n^2 (1 - k_n^2).
inline double break_energy(double v_n, double k_n) {
  return 0.5 * v_n * v_n * (1.0 - k_n * k_n);
}

/// The masses of what a block breaks into: the first stays the block of the path. Their sum is the mass but for
/// rounding. One mass only where no piece would reach kSmallestPiece.
///
/// @param most  pieces that may break off
std::vector<double> piece_masses(const Fragmentation& effect, double mass, std::uint32_t most);

/// Breaks a block that has just rebounded.
///
/// @param block    becomes the largest piece;  motion: its velocity is scaled by sqrt(kBreakKeeps)
/// @param normal   of the smooth surface: no piece flies into it
/// @param path     gets the pieces, each at the same place with the same spin, and the break
/// @return         whether it broke
bool break_up(const Fragmentation& effect, const Release& release, const Vec3& normal, Block& block, Motion& motion,
              Path& path);

}  // namespace talus
