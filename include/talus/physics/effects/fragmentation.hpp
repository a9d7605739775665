#pragma once
#include "talus/base/random.hpp"
#include "talus/physics/effects/effect_area.hpp"
#include "talus/physics/path.hpp"

namespace talus {

/// A block that breaks at a hard impact.
struct Fragmentation {
  static constexpr bool kLeavesPlane = true;
  double threshold = 0.0;  ///< it breaks if it loses more normal energy per mass than this [J/kg]; 0: never
  double largest = 0.5;    ///< share of the mass that the largest piece keeps, in [1/2, 1)
  EffectArea where;
};

/// fragmentation. docs/effects.md, "fragmentation".

inline constexpr int kPiecesAtOnce = 4;        ///< largest number of pieces that break off at one impact
inline constexpr double kSmallestPiece = 1.0;  ///< [kg]; if a piece would be smaller, fewer pieces break off
inline constexpr double kConeAngle = 50.0;     ///< full opening angle of the cone of directions [deg]
inline constexpr double kBreakKeeps = 0.99;    ///< share of the translational energy that is kept

/// Energy of the motion normal to the plane that is lost at an impact, per mass [J/kg]: 1/2 v_n^2 (1 - k_n^2).
inline double break_energy(double v_n, double k_n) {
  return 0.5 * v_n * v_n * (1.0 - k_n * k_n);
}

/// Masses of the pieces of a block [kg]: the first is the largest, which continues as the block of the path. Their sum
/// is the mass of the block except for rounding. Only one mass if no piece would reach kSmallestPiece.
///
/// @param mass  of the block [kg]
/// @param most  largest number of pieces that may break off
std::vector<double> piece_masses(const Fragmentation& effect, double mass, std::uint32_t most);

/// Breaks a block that has just rebounded.
///
/// @param normal   of the smooth surface: no piece flies into it
/// @param block    becomes the largest piece
/// @param motion   its velocity is multiplied by sqrt(kBreakKeeps)
/// @param path     gets the break and the pieces, each with the same position and spin
/// @return         whether the block broke
bool break_up(const Fragmentation& effect, const Release& release, const Vec3& normal, Block& block, Motion& motion,
              Path& path);

}  // namespace talus
