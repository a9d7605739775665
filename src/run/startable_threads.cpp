#include "talus/run/startable_threads.hpp"

#include <omp.h>
#include <sys/resource.h>

#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace talus::run {
namespace {

/// How many of these threads can be there at once, this one included.
int tried(int threads) {
  std::vector<std::thread> started;
  started.reserve(static_cast<std::size_t>(threads));
  std::latch end(1);
  try {
    while (static_cast<int>(started.size()) + 1 < threads) started.emplace_back([&end] { end.wait(); });
  } catch (const std::system_error&) {
    // so many, and no more
  }
  end.count_down();
  for (std::thread& thread : started) thread.join();
  return static_cast<int>(started.size()) + 1;
}

bool memory_is_limited() {
  rlimit limit{};
  return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace

int startable_threads(int threads) {
  if (threads <= omp_get_num_procs() && !memory_is_limited()) return threads;
  const int most = tried(threads);
  if (most < threads) return most;
#pragma omp parallel num_threads(threads)
  {
    // starts them now: what is read later must not take their place
  }
  return threads;
}

}  // namespace talus::run
