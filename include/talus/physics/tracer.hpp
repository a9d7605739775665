#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include "talus/physics/path.hpp"
#include "talus/physics/world.hpp"

namespace talus {

/// Trajectories traced in the lanes of one instruction: 8 with AVX-512 (F, DQ, VL), 4 with AVX2, else 1.
inline constexpr int kLaneChoices[] = {1, 4, 8};

/// The most lanes that this processor and this build have.
int most_lanes();

/// The lanes in which blocks are traced in this world, if `asked` of them are asked for: 1 with effects or barriers.
/// @param asked  0: the most
int lanes_in(const World& world, int asked);

/// Gives the next block and a number for it that comes back with its path; false: there is none, and it is not called
/// again in this run.
using NextRelease = std::function<bool(Release&, std::uint64_t& tag)>;
/// Receives a path, which is valid during the call.
using PathDone = std::function<void(const Release&, const Path&, std::uint64_t tag)>;

class Pool;

/// Traces many blocks. Its buffers are reused.
///
/// The paths have the same bits as those of `trace`, for any number of lanes, and come in the order of the releases. In
/// a world with effects or barriers blocks are traced one by one.
class Tracer {
 public:
  /// @param lanes  1, 4 or 8, at most `most_lanes()`; 0: the most
  /// The world must outlive it.
  explicit Tracer(const World& world, int lanes = 0);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// Traces block after block until `next` has none and all are done. Exceptions of both functions are passed on; the
  /// blocks on their way are then lost.
  void run(const NextRelease& next, const PathDone& done);

  int lanes() const { return lanes_; }

 private:
  const World& world_;
  int lanes_;
  std::unique_ptr<Pool> pool_;  // null: one by one
  Path path_;
};

}  // namespace talus
