#pragma once
#include <omp.h>

#include <exception>

namespace talus {

/// Calls `work` in each thread of a parallel region. An exception must not leave the region: the first one is kept, and
/// thrown again after it. The other threads go on: `work` tells them by itself if they are to stop.
///
/// @param threads  0: all processors
template <class Work>
void in_threads(int threads, const Work& work) {
  std::exception_ptr failure;
#pragma omp parallel num_threads(threads > 0 ? threads : omp_get_num_procs()) default(none) shared(work, failure)
  try {
    work();
  } catch (...) {
#pragma omp critical(talus_in_threads)
    if (!failure) failure = std::current_exception();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace talus
