#pragma once
#include <memory>
#include <vector>

#include "talus/base/not_set.hpp"
#include "talus/physics/barriers.hpp"
#include "talus/physics/block.hpp"
#include "talus/terrain/surface.hpp"

namespace talus {

/// How a trajectory ended; each has exactly one end. docs/physics.md, "End of a trajectory".
enum class End : std::uint8_t { Stopped, Trapped, Left, Caught, Limit };
inline constexpr int kEnds = 5;

/// Whether the block stays on the ground where its path ended, without a barrier.
constexpr bool rests_on_ground(End end) {
  return end == End::Stopped || end == End::Trapped;
}

/// Whether the block stays where its path ended.
constexpr bool rests(End end) {
  return rests_on_ground(end) || end == End::Caught;
}

/// Event at a vertex of a path; it tells what follows.
enum class Event : std::uint8_t {
  Release,  ///< the first flight
  Impact,   ///< a rebound; a flight or a slide follows
  Slide,    ///< a piece of sliding
  Takeoff,  ///< a flight after sliding, without an impact
  Air,      ///< a further parabola of a flight with drag
  Stem,     ///< a flight after a stem was hit; at the end of a slide the impact or takeoff is at the same place
  Barrier,  ///< a flight or a slide after it broke a barrier
  End       ///< the last vertex
};

/// A point of the path, with the motion after its event. A flight follows its parabola to the next vertex with constant
/// spin; a piece of sliding is short enough to be taken as straight in plan.
struct Vertex {
  Motion motion;
  Event event;
};

/// The motion between two successive vertices of a path, on the straight line in plan between them.
///
/// @param share  of the way in plan, 0 at `from`, 1 at `to`
///
/// In a flight, a parabola with constant spin, the velocity in plan is constant: `share` is also that of the time. A
/// piece of sliding has a constant acceleration: the square of its speed is linear in `share`, its time is not, and a
/// block that starts at rest has used sqrt(share) of the time. The speed at its end follows from the way, the time and
/// the velocity at its start: 2 way / duration - velocity. docs/physics.md, "Sliding".
Motion motion_between(const Vertex& from, const Vertex& to, double share);

/// The way across one patch, from `from` to `to` in patch coordinates. The clearance is quadratic in the share s of the
/// way: height(s) = height_from + s ((height_to - height_from) - bend (1 - s)). It is 0 in a slide.
struct Span {
  PatchIndex patch;
  float p_from, q_from, p_to, q_to;    ///< patch coordinates [-]
  float height_from, height_to, bend;  ///< clearance above the ground [m]; bend is f2 dt^2
  float plan_speed_squared;            ///< [m^2/s^2]; for a slide 0
  float rise_from, rise_to;            ///< vertical speed at the ends [m/s]; for a slide the whole speed
  std::uint32_t impacts;               ///< at its end; more than one if the block could not move between them
};

/// The spin of a block from one of its spans on: it is constant between impacts.
struct SpinFrom {
  std::size_t span;  ///< index of the first span
  double spin;       ///< angular velocity [rad/s]
};

/// The rest of a block after a break.
struct Broken {
  std::size_t vertex, span;  ///< its first vertex and first span
  Block body;
};

/// A buffer whose elements are not set when `resize` adds them.
template <class T>
using Buffer = std::vector<T, NotSet<std::allocator<T>>>;

/// One trajectory: plain data between the engine and its readers (tallies, screens, recordings). Reused as a buffer.
struct Path {
  Buffer<Vertex> vertices;
  Buffer<Span> spans;
  Buffer<SpinFrom> spins;  ///< in the order of time
  End end = End::Limit;
  std::uint32_t impacts = 0;
  std::uint32_t psi_dropped = 0;         ///< impacts at which psi was left out
  double length = 0.0;                   ///< in space [m]
  double plan_length = 0.0;              ///< in plan [m]
  double mass = 0.0;                     ///< of the block at its end [kg]
  std::vector<Broken> breaks;            ///< in the order of time
  std::vector<Release> pieces;           ///< pieces that broke off; `trace_pieces` follows them
  std::vector<BarrierPassage> barriers;  ///< meetings with barriers, in the order of time

  void clear() {
    vertices.clear();
    spans.clear();
    spins.clear();
    end = End::Limit;
    impacts = psi_dropped = 0;
    length = plan_length = mass = 0.0;
    breaks.clear();
    pieces.clear();
    barriers.clear();
  }
};

}  // namespace talus
