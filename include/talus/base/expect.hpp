#pragma once

namespace talus {

/// Tells of an invariant that does not hold (file, line, condition, text), on one line of stderr, and aborts.
[[noreturn]] void abort_broken(const char* file, int line, const char* condition, const char* text) noexcept;

}  // namespace talus

/// TALUS_EXPECT(condition, "text"): an invariant, which holds whatever the input is. Faults of the user are no matter
/// for it: those are an InputError.
///
/// Checked where TALUS_CHECKED is defined: in Debug builds (the presets dev and asan) and with the CMake option of that
/// name. A broken one aborts, so that it cannot be caught on its way through threads and destructors, and a debugger
/// stands where it happened. Elsewhere, as in a release, nothing is computed: the same code, bits and speed.
#ifdef TALUS_CHECKED
#define TALUS_EXPECT(condition, text) \
  ((condition) ? static_cast<void>(0) : ::talus::abort_broken(__FILE__, __LINE__, #condition, text))
#else
#define TALUS_EXPECT(condition, text) static_cast<void>(sizeof((condition) ? 1 : 0))
#endif
