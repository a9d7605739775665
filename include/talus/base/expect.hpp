#pragma once

namespace talus {

/// Reports an invariant that does not hold on one line of stderr (file, line, condition, text), and aborts.
[[noreturn]] void abort_broken(const char* file, int line, const char* condition, const char* text) noexcept;

}  // namespace talus

/// TALUS_EXPECT(condition, "text"): an invariant, which holds for any input. An error of the user is an InputError
/// instead.
///
/// Checked if TALUS_CHECKED is defined: in Debug builds (the presets dev and asan) and with the CMake option of that
/// name. A broken invariant aborts: nothing can catch it on the way through threads and destructors, and a debugger
/// stops where it happened. In all other builds the condition is not computed: same code, bits and speed as without it.
#ifdef TALUS_CHECKED
#define TALUS_EXPECT(condition, text) \
  ((condition) ? static_cast<void>(0) : ::talus::abort_broken(__FILE__, __LINE__, #condition, text))
#else
#define TALUS_EXPECT(condition, text) static_cast<void>(sizeof((condition) ? 1 : 0))
#endif
