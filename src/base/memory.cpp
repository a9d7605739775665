#include "talus/base/memory.hpp"

#include <cstdlib>  // defines __GLIBC__ if that is the C library

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace talus {

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_TOP_PAD, 16 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that it takes; larger blocks go back when they are freed
#endif
}

}  // namespace talus
