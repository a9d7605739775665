#include "talus/physics/trace.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "anchor.hpp"
#include "barrier_watch.hpp"
#include "physics/effects/active_effects.hpp"
#include "staying.hpp"
#include "talus/base/expect.hpp"

namespace talus {
namespace {

[[maybe_unused]] constexpr double kPatchError = 1e-6;  // of the place of a block in its patch, by rounding [patches]

/// The half of a creased patch that a block meets. (Apart, and by value, so that the usual patch stays in registers.)
[[gnu::noinline]] Patch creased_facet(const Surface& surface, Patch patch, double p, double q, const Vec3& velocity) {
  return surface.facet(patch, p, q, velocity);
}

/// State of one block on its path, shared by all steps. A step returns the end of the trajectory, or nothing.
///
/// @tparam Acting  Effectless (the compiler removes all code of effects) or ActiveEffects; either of them alone or in
///                 BehindBarriers
template <class Acting>
class Walk {
 public:
  Walk(const World& world, const Release& release, Path& path)
      : world_(world),
        body_(release.body),
        effects_(world, release),
        asperities_(Random(release.seed, release.source, release.block, Purpose::Impact, release.piece),
                    world.impact.roughness),
        path_(path),
        motion_(release.motion),
        at_(world.surface.patch_at(motion_.position.x(), motion_.position.y())),
        anchor_(world.rules.trap_time) {}

  End run() {
    path_.vertices.push_back({motion_, Event::Release});
    path_.spins.push_back({0, motion_.spin.norm()});
    if (const auto end = end_of(effects_.fly(motion_, at_, false, body_, path_))) return *end;
    anchor_.set(motion_);
    while (path_.impacts < world_.rules.impact_limit && motion_.time < world_.rules.time_limit &&
           path_.vertices.size() < world_.effort.most_vertices && path_.spans.size() < kMostSpans) {
      if (const auto end = meet_the_ground()) return *end;
      if (motion_.velocity.dot(normal_) < kSlideSpeed) {
        const SlideEnd how = slide_on();
        if (const auto end = end_of(how)) return *end;
        if (how == SlideEnd::NextAsperity) continue;
        path_.vertices.push_back({motion_, Event::Takeoff});
      }
      if (const auto end = fly_on()) return *end;
    }
    return End::Limit;
  }

  const Motion& motion() const { return motion_; }
  const Block& body() const { return body_; }

 private:
  static std::optional<End> end_of(FlightEnd how) {
    if (how == FlightEnd::Left) return End::Left;
    if (how == FlightEnd::Aloft) return End::Limit;
    if (how == FlightEnd::Caught) return End::Caught;
    return std::nullopt;
  }
  std::optional<End> end_of(SlideEnd how) {
    if (how == SlideEnd::Left) return End::Left;
    if (how == SlideEnd::Stopped) return End::Stopped;
    if (how == SlideEnd::Caught) return End::Caught;
    if (how == SlideEnd::Trapped || anchor_.holds(motion_, body_.diameter)) return end_of_staying();
    return std::nullopt;
  }

  /// An impact at the place of the block. The block stops if it is slow after it, on ground no steeper than phi, or if
  /// an effect holds it.
  /// (Flattened, as the plain `fly` and `impact`: functions that effects also call are inlined here.)
  [[gnu::flatten]] std::optional<End> meet_the_ground() {
    decltype(auto) ground = effects_.ground(motion_.position, body_);
    Patch patch;
    const bool there = world_.surface.read(at_, patch);
    TALUS_EXPECT(there, "a block on the ground is on a patch that exists");
    const double p = world_.surface.u_of(motion_.position.x()) - at_.column;
    const double q = world_.surface.v_of(motion_.position.y()) - at_.row;
    if (world_.surface.crease(patch) != Crease::None) [[unlikely]]
      patch = creased_facet(world_.surface, patch, p, q, motion_.velocity);
    normal_ = normal_of(world_.surface.gradient(patch, p, q));
    TALUS_EXPECT(std::abs(p - 0.5) < 0.5 + kPatchError && std::abs(q - 0.5) < 0.5 + kPatchError,
                 "a block is above its patch");
    const Asperity asperity = asperities_.at(path_.impacts, ground);
    const Contact contact = effects_.impact(ground, body_, motion_, normal_, asperity);
    TALUS_EXPECT(contact.velocity.allFinite() && contact.spin.allFinite(), "an impact ends in a finite motion");
    motion_.velocity = contact.velocity;
    motion_.spin = contact.spin;
    effects_.after_impact(normal_, body_, motion_, path_);
    path_.vertices.push_back({motion_, Event::Impact});
    path_.spins.push_back({path_.spans.size(), motion_.spin.norm()});
    path_.spans.back().impacts += 1;
    path_.impacts += 1;
    path_.psi_dropped += contact.psi_dropped ? 1U : 0U;
    const bool fast = motion_.velocity.squaredNorm() >= world_.rules.stop_speed * world_.rules.stop_speed;
    if (!fast && normal_.head<2>().norm() <= ground.tan_phi * normal_.z()) return End::Stopped;
    if (effects_.holds({ground, body_, motion_.velocity, normal_, asperity})) return End::Stopped;
    return std::nullopt;
  }

  /// Slides from the place of the block; the part of its velocity normal to the surface is lost.
  SlideEnd slide_on() {
    motion_.velocity -= motion_.velocity.dot(normal_) * normal_;
    const Motion before = motion_;
    const SlideEnd how = effects_.slide(motion_, at_, body_, path_);
    if (how == SlideEnd::Takeoff || how == SlideEnd::NextAsperity) effects_.after_slide(before, body_, motion_, path_);
    return how;
  }

  /// Flies from the surface to the next contact.
  std::optional<End> fly_on() {
    if (const auto end = end_of(effects_.fly(motion_, at_, true, body_, path_))) return *end;
    if (anchor_.holds(motion_, body_.diameter)) return end_of_staying();
    return std::nullopt;
  }

  End end_of_staying() {
    return talus::end_of_staying(world_, effects_.ground(motion_.position, body_), motion_, at_, body_.diameter);
  }

  const World& world_;
  Block body_;
  Acting effects_;
  Asperities asperities_;
  Path& path_;
  Motion motion_;
  PatchIndex at_;
  Vec3 normal_;  // of the smooth surface at the last impact
  Anchor anchor_;
};

template <class Acting>
void walk(const World& world, const Release& release, Path& path) {
  Walk<Acting> block(world, release, path);
  path.end = block.run();
  TALUS_EXPECT(block.motion().time >= release.motion.time, "time goes on");
  TALUS_EXPECT(block.body().mass <= release.body.mass, "a block does not gain mass");
  path.mass = block.body().mass;
  path.vertices.push_back({block.motion(), Event::End});
}

}  // namespace

void trace(const World& world, const Release& release, Path& path) {
  path.clear();
  if (world.barriers == nullptr)
    world.effects == nullptr ? walk<Effectless>(world, release, path) : walk<ActiveEffects>(world, release, path);
  else
    world.effects == nullptr ? walk<BehindBarriers<Effectless>>(world, release, path)
                             : walk<BehindBarriers<ActiveEffects>>(world, release, path);
}

void trace_pieces(const World& world, const Path& whole,
                  const std::function<void(const Release&, const Path&)>& visit) {
  std::vector<Release> pieces = whole.pieces;
  Path path;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Release piece = pieces[i];
    piece.piece = static_cast<std::uint32_t>(i + 1);
    piece.pieces_left = kMostPieces - std::min(kMostPieces, static_cast<std::uint32_t>(pieces.size()));
    trace(world, piece, path);
    pieces.insert(pieces.end(), path.pieces.begin(), path.pieces.end());
    visit(piece, path);
  }
}

}  // namespace talus
