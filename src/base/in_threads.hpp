#pragma once
#include <omp.h>

#include <atomic>
#include <cstddef>
#include <exception>

namespace talus {

/// Calls `work` in each thread of a parallel region. An exception must not leave the region: the first one is kept, and
/// thrown again after it. `on_failure` tells the other threads to stop.
///
/// @param threads  0: all processors
template <class Work, class OnFailure>
void in_threads(int threads, const Work& work, const OnFailure& on_failure) {
  std::exception_ptr failure;
#pragma omp parallel num_threads(threads > 0 ? threads : omp_get_num_procs()) default(none) \
    shared(work, on_failure, failure)
  try {
    work();
  } catch (...) {
    on_failure();
#pragma omp critical(talus_in_threads)
    if (!failure) failure = std::current_exception();
  }
  if (failure) std::rethrow_exception(failure);
}

/// Calls `work` with 0 to `count` - 1, the next one in whatever thread is free; after a failure with no further one.
template <class Work>
void in_parallel(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  in_threads(
      threads,
      [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
      },
      [&] { next = count; });
}

}  // namespace talus
