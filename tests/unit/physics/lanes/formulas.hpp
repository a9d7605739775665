#pragma once
#include <cstdint>

namespace talus::test {

/// Formulas in lanes, on arrays of a multiple of eight numbers; compiled with the instructions that they need.
struct Formulas {
  void (*natural_log)(const double* x, double* result, int count);
  void (*sine_cosine)(const double* turn, double* sine, double* cosine, int count);
  /// @param words  four for each number, as [word][number]; replaced by those of Philox
  void (*philox)(std::uint64_t* words, const std::uint64_t* key, int count);
  void (*first_contact)(const double* f0, const double* f1, const double* f2, const double* until, double* result,
                        int count);
  /// @param vectors  three for each number, as [component][number]: u, v
  void (*dot_and_cross)(const double* u, const double* v, double* dot, double* cross, int count);
};
Formulas formulas_in_4_lanes();
Formulas formulas_in_8_lanes();

}  // namespace talus::test
