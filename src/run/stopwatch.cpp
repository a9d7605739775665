#include "talus/run/stopwatch.hpp"

#include <chrono>
#include <ctime>

namespace talus::run {

Stopwatch::Lap Stopwatch::lap() {
  const Lap now = read(), lap{now.cpu - last_.cpu, now.wall - last_.wall};
  last_ = now;
  return lap;
}

Stopwatch::Lap Stopwatch::read() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  return {static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec),
          std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count()};
}

}  // namespace talus::run
