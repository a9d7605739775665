#include "talus/physics/tracer.hpp"

#include "lanes/engine.hpp"
#include "lanes/pool.hpp"
#include "talus/base/expect.hpp"
#include "talus/physics/trace.hpp"

namespace talus {

int most_lanes() {
#ifdef TALUS_HAS_LANES
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return 8;
  if (__builtin_cpu_supports("avx2")) return 4;
#endif
  return 1;
}

int lanes_in(const World& world, int asked) {
  TALUS_EXPECT(asked <= most_lanes(), "lanes that this processor has");
  if (world.effects != nullptr || world.barriers != nullptr) return 1;
  return asked == 0 ? most_lanes() : asked;
}

Tracer::Tracer(const World& world, int lanes) : world_(world), lanes_(lanes_in(world, lanes)) {
  if (lanes_ > 1) pool_ = std::make_unique<Pool>(world, lanes_);
}

Tracer::~Tracer() = default;

void Tracer::run(const NextRelease& next, const PathDone& done) {
  if (pool_ == nullptr) {
    Release release;
    std::uint64_t tag = 0;
    while (next(release, tag)) {
      trace(world_, release, path_);
      done(release, path_, tag);
      release = Release{};
    }
    return;
  }
#ifdef TALUS_HAS_LANES
  pool_->fill(next, done);
  lanes_ == 8 ? follow_in_8_lanes(*pool_) : follow_in_4_lanes(*pool_);
#endif
}

}  // namespace talus
