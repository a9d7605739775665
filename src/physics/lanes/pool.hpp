#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "talus/physics/path.hpp"
#include "talus/physics/tracer.hpp"

/// Data shared by the code in lanes and the code for one lane: plain, so that the former calls no inline function that
/// others use (see src/physics/lanes/lanes.hpp).
namespace talus {

/// Numbers of a block, in the order in which they lie in `Slot::state`: first those of Motion.
namespace field {
enum : std::uint8_t {
  Time,
  X,
  Y,
  Z,
  VelocityX,
  VelocityY,
  VelocityZ,
  SpinX,
  SpinY,
  SpinZ,  // clang-format: one line
  Length,
  PlanLength,
  AnchorX,
  AnchorY,
  AnchorZ,
  AnchorTime,  // the last that an impact may change: see write_impacts
  Diameter,
  Event,
  PurposeWord,
  Source,
  BlockNumber,
  KeyLow,
  KeyHigh,  // words of its random numbers, as whole numbers
  Count = 24
};
}  // namespace field

/// One block of the pool, at the start of its flight, or on the ground.
struct alignas(64) Slot {
  double state[field::Count];
  Span *first_span, *span, *last_span;  ///< of its path: first, next, and the last that may be written
  Vertex *first_vertex, *vertex, *last_vertex;
  SpinFrom* spin;
  std::uint32_t impacts, psi_dropped;
  std::uint64_t number, tag;  ///< in the order of the releases; of the caller
  Release release;
  Path path;  ///< its buffers; complete at the end only
};

/// Blocks that wait: number by number, so that several are taken by one instruction. The first come first: what was
/// written last is not in the cache yet, and reading it would wait for that.
template <int kFields>
struct Queue {
  static constexpr int kMost = 32;  // blocks
  alignas(64) double at[kFields][2 * kMost + 8];
  int first = 0, end = 0;

  [[gnu::always_inline]] int size() const { return end - first; }
  /// Moves the blocks to the beginning.
  [[gnu::always_inline]] void pack() {
    for (auto& numbers : at)
      __builtin_memmove(numbers, numbers + first, sizeof(double) * static_cast<std::size_t>(size()));
    end -= first;
    first = 0;
  }
};

/// Blocks that start a flight.
namespace flight {
enum : std::uint8_t {
  Place,
  U0,
  V0,
  RateU,
  RateV,
  Z0,
  Rise,
  NextColumn,
  EveryColumn,
  NextRow,
  EveryRow,
  Plan2,
  Column,
  Row,
  Grounded,
  Count
};
}  // namespace flight
/// Blocks that came to the ground: after a flight of this time, at this height, in this patch.
namespace landing {
enum : std::uint8_t { Place, Time, Z, Column, Row, Count };
}  // namespace landing

/// The world as the lanes need it.
struct LaneWorld {
  const float* heights;
  double columns, rows, per_cell_x, per_cell_y, cell_x, cell_y;
  bool creased;
  const Ground* grounds;
  const std::uint8_t* zones;  ///< null: the same ground everywhere
  ImpactModel impact;
  double stop_speed, trap_time, time_limit;
  std::uint32_t impact_limit;
  std::size_t most_vertices, most_spans;  ///< in bytes of a path
  double most_crossed;                    ///< patches crossed in one flight
};

/// The blocks on their way. All functions are for one block at a time.
class Pool {
 public:
  /// Holds four blocks for each lane. Two would keep all lanes busy: while too few for an impact have landed, at least
  /// as many fly as there are lanes. More leave time between writing and reading a queue.
  ///
  /// @param lanes  of the engine
  Pool(const World& world, int lanes);
  ~Pool();

  LaneWorld terrain;
  Queue<flight::Count> flying;
  Queue<landing::Count> landed;

  /// Fills the pool with blocks. From then on each block that ends makes room for the next.
  void fill(const NextRelease& next, const PathDone& done);

  /// Makes room for spans. False: the path is too long for the pool; it was traced in one lane instead, and the slot
  /// has another block or none.
  bool more_spans(Slot& slot);
  void more_vertices(Slot& slot);
  /// The flight of a block left the terrain after this time [s].
  void leave(Slot& slot, double time);
  /// The block is at its anchor for too long.
  void stay(Slot& slot, int column, int row);
  /// The block slides from its place on a surface of this normal.
  void slide(Slot& slot, const double* normal, int column, int row);
  void end(Slot& slot, End end);

 private:
  /// A block of the order of the releases: on its way, or ended before one that was released earlier.
  struct Waiting {
    bool ended = false;
    std::uint64_t tag = 0;
    Release release;
    Path path;
  };

  void start(Slot& slot);
  void hand_over(Slot& slot, Path& path);
  void hand_out();
  void push_flight(Slot& slot, PatchIndex at, bool grounded);
  void open(Slot& slot);
  Motion motion_of(const Slot& slot) const;
  void set_motion(Slot& slot, const Motion& motion) const;
  bool holds(Slot& slot, const Motion& motion) const;
  void push_vertex(Slot& slot, Event event);

  const World& world_;
  const NextRelease* next_ = nullptr;
  const PathDone* done_ = nullptr;
  int size_;
  std::unique_ptr<Slot[]> slots_;
  std::vector<Slot*> idle_;    // slots without a block
  bool exhausted_ = false;     // no release is left
  std::deque<Waiting> order_;  // the blocks that are not handed out
  std::uint64_t first_ = 0;    // number of the first of them
  std::size_t waiting_ = 0;    // bytes of the paths of those that ended
  std::vector<Path> spare_;    // buffers
  Path slide_, long_;
};

}  // namespace talus
