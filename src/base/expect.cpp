#include "talus/base/expect.hpp"

#include <cstdio>
#include <cstdlib>

namespace talus {

void abort_broken(const char* file, int line, const char* condition, const char* text) noexcept {
  std::fprintf(stderr, "%s:%d: an invariant is broken: %s (%s)\n", file, line, text, condition);
  std::abort();
}

}  // namespace talus
