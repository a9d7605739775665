#pragma once
#include "scenes.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/physics/trace.hpp"

/// A world with effects on a plane, for the tests of the effects.
namespace talus::test {

/// Ground that takes nothing at all: no roughness, and no loss at an impact but by friction.
inline constexpr Ground kPerfect{.En50 = 1e300, .Et50 = 1e300, .tan_phi = 5.0};

inline constexpr Ground kUpperTalus{.theta_scale = 1.0, .psi_scale = 0.9, .shape_max = 1.5};

struct Hillside {
  Surface surface;
  Cover cover{{Ground{}}, {}};
  Effects effects{};
  ImpactModel impact{};
  EndRules rules{};
  bool acting = true;

  /// A plane that falls to the east by `slope` metres per metre, at 1000 m at x = 0.
  explicit Hillside(double slope, double cell = 4.0, int n = 200)
      : surface(terrain(grid_of(n, n, cell, cell), [slope](double x, double) { return 1000.0 - slope * x; })) {}

  World world() const { return {surface, cover, impact, rules, acting ? &effects : nullptr}; }

  Path run(const Release& release) const {
    Path path;
    trace(world(), release, path);
    return path;
  }
};

/// A block of a diameter [m] and 2700 kg/m^3 at a place with a velocity.
inline Release block_at(const Vec3& position, const Vec3& velocity, double diameter = 1.0, std::uint32_t block = 0) {
  Release release;
  release.block = block;
  release.body = block_of(diameter, 2700.0);
  release.motion.position = position;
  release.motion.velocity = velocity;
  return release;
}

/// Whether all numbers of two paths are the same, bit for bit.
inline bool same_bits(const Path& a, const Path& b) {
  if (a.vertices.size() != b.vertices.size() || a.end != b.end || a.impacts != b.impacts || a.length != b.length ||
      a.mass != b.mass || a.pieces.size() != b.pieces.size())
    return false;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    const Motion &m = a.vertices[i].motion, &n = b.vertices[i].motion;
    if (m.time != n.time || m.position != n.position || m.velocity != n.velocity || m.spin != n.spin ||
        a.vertices[i].event != b.vertices[i].event)
      return false;
  }
  return true;
}

}  // namespace talus::test
