#include "talus/physics/impact.hpp"

#include "talus/base/expect.hpp"

namespace talus {
void Asperities::draw(std::uint32_t first_event) {
  std::array<Words, kAhead> words;
  for (std::uint32_t i = 0; i < kAhead; ++i) words[i] = random_.words(first_event + i);
  for (std::uint32_t i = 0; i < kAhead; ++i) {
    const auto [longitudinal, transverse, shape, heading] =
        asperity_draw(words[i][0], words[i][1], words[i][2], words[i][3]);
    draws_[i] = {longitudinal, transverse, shape, heading};
  }
  first_ = first_event;
}

Asperity Asperities::at(std::uint32_t event, const Ground& ground) {
  if (event - first_ >= kAhead) draw(event - event % kAhead);
  AsperityDraw<double> draw = draws_[event - first_];
  if (rule_ == Roughness::Resample)
    for (std::uint32_t part = 1; draw.longitudinal < kLowestBracket && part < kMaxRedraws; ++part) {
      const Words words = random_.words(event, part);
      draw.longitudinal = normal_pair(words[0], words[1])[0];
    }
  return asperity_of(draw, ground);
}

RoughPlane rough_plane(const Vec3& normal, const Vec3& velocity, const Asperity& asperity) {
  return rough_plane<double>(normal, velocity, asperity);
}

Rebound rebound(const Vec3& velocity, const Vec3& spin, const Vec3& n, const Restitution& k, double arm,
                double tan_phi) {
  return rebound<double>(velocity, spin, n, k, arm, tan_phi);
}

// Flattened (all calls inlined): otherwise the plain engine takes a tenth longer.
[[gnu::flatten]] Contact impact(const ImpactModel& model, const Ground& ground, const Block& block,
                                const Motion& before, const Vec3& normal, const Asperity& asperity) {
  return impact(model, ground, block, before, normal, asperity, NoChanges{});
}

}  // namespace talus
