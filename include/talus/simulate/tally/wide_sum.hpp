#pragma once
#include <cmath>
#include <cstdint>

namespace talus {

/// A sum of whole numbers from 0 up, in 128 bits: the same in any order. It holds 2^64 numbers of 64 bits.
struct WideSum {
  std::uint64_t low = 0, high = 0;  ///< the sum is high 2^64 + low

  WideSum& operator+=(std::uint64_t more) {
    low += more;
    high += low < more ? 1U : 0U;
    return *this;
  }
  WideSum& operator+=(const WideSum& other) {
    *this += other.low;
    high += other.high;
    return *this;
  }
  explicit operator double() const { return std::ldexp(static_cast<double>(high), 64) + static_cast<double>(low); }
  bool operator==(const WideSum&) const = default;
};

}  // namespace talus
