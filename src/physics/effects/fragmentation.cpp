#include "talus/physics/effects/fragmentation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {

constexpr double kRankExponent = 1.2;  // of the power law of mass by rank: 3 / D_f with D_f = 2.5

/// Random direction in the cone around `axis`, uniform over its solid angle. A direction into the surface is mirrored
/// at the surface.
Vec3 direction_in_cone(const Vec3& axis, const Vec3& normal, const Words& words) {
  const double narrowest = sine_cosine_of_turn(0.5 * kConeAngle / 360.0).cosine;
  const double cosine = 1.0 - uniform(words[0]) * (1.0 - narrowest), sine = std::sqrt(1.0 - cosine * cosine);
  const SineCosine around = sine_cosine_of_turn(uniform(words[1]));
  const Vec3 least = std::abs(axis.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 side = axis.cross(least).normalized(), other = axis.cross(side);
  const Vec3 direction = cosine * axis + sine * (around.cosine * side + around.sine * other);
  return direction - 2.0 * std::min(0.0, direction.dot(normal)) * normal;
}

Block piece_of(const Block& block, double mass) {
  return {block.diameter * power(mass / block.mass, 1.0 / 3.0), mass, block.axes};
}

}  // namespace

std::vector<double> piece_masses(const Fragmentation& effect, double mass, std::uint32_t most) {
  const double largest = effect.largest * mass, rest = mass - largest;
  for (int count = std::min<int>(kPiecesAtOnce, static_cast<int>(most)); count > 0; --count) {
    std::array<double, kPiecesAtOnce> share{};
    double sum = 0.0;
    for (int i = 0; i < count; ++i) sum += share[i] = power(i + 1.0, -kRankExponent);
    if (rest * share[count - 1] / sum < kSmallestPiece) continue;
    std::vector<double> masses{largest};
    for (int i = 0; i < count; ++i) masses.push_back(rest * (share[i] / sum));
    return masses;
  }
  return {mass};
}

bool break_up(const Fragmentation& effect, const Release& release, const Vec3& normal, Block& block, Motion& motion,
              Path& path) {
  const auto broken_off = static_cast<std::uint32_t>(path.pieces.size());
  const std::vector<double> masses = piece_masses(effect, block.mass, release.pieces_left - broken_off);
  const double speed = motion.velocity.norm();
  if (masses.size() < 2 || !(speed > 0.0)) return false;
  motion.velocity *= std::sqrt(kBreakKeeps);
  const Random random(release.seed, release.source, release.block, Purpose::Break, release.piece);
  for (std::uint32_t i = 1; i < masses.size(); ++i) {
    Release piece = release;
    piece.body = piece_of(block, masses[i]);
    piece.motion = motion;
    piece.motion.velocity = std::sqrt(kBreakKeeps) * speed *
                            direction_in_cone(motion.velocity.normalized(), normal, random.words(path.impacts, i));
    path.pieces.push_back(piece);
  }
  block = piece_of(block, masses[0]);
  path.breaks.push_back({path.vertices.size(), path.spans.size(), block});
  return true;
}

}  // namespace talus
