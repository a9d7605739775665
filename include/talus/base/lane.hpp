#pragma once
#include <cmath>

#include "talus/base/vector.hpp"

namespace talus {

/// Words for formulas that are written once for a number and for several numbers in the lanes of one instruction.
///
/// `Number` is double, or `Lanes<N>` (src/physics/lanes/lanes.hpp), which has the same functions. A condition on a
/// `Number` is a `MaskOf<Number>`: bool, or one bit for each lane; `&` and `|` join them. `if (all(...))` is a branch
/// for one lane, and for several a way out that all of them take. Each lane has the bits that one lane has.
template <class Number>
struct LaneTypes;
template <>
struct LaneTypes<double> {
  using Mask = bool;
  using Vector = Vec3;
};
template <class Number>
using MaskOf = typename LaneTypes<Number>::Mask;
template <class Number>
using VectorOf = typename LaneTypes<Number>::Vector;  ///< three of them, with the functions of Vec3

[[gnu::always_inline]] inline bool all(bool condition) {
  return condition;
}
[[gnu::always_inline]] inline bool any(bool condition) {
  return condition;
}
[[gnu::always_inline]] inline bool opposite(bool condition) {
  return !condition;
}
[[gnu::always_inline]] inline double choose(bool condition, double yes, double no) {
  return condition ? yes : no;
}
[[gnu::always_inline]] inline Vec3 choose(bool condition, const Vec3& yes, const Vec3& no) {
  return condition ? yes : no;
}
[[gnu::always_inline]] inline double smaller(double a, double b) {  // std::min
  return b < a ? b : a;
}
[[gnu::always_inline]] inline double larger(double a, double b) {  // std::max
  return a < b ? b : a;
}
[[gnu::always_inline]] inline double root(double x) {
  return std::sqrt(x);
}
[[gnu::always_inline]] inline double magnitude(double x) {
  return std::abs(x);
}

}  // namespace talus
