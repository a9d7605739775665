#pragma once
#include <cstdint>
#include <string_view>

namespace talus {

/// Number of the random stream of a thing that has a name, such as a measured block: a hash of the name. The stream
/// then follows from the name alone, not from the place of the thing in a file or from what stands beside it.
///
/// Two names out of n have the same number with a probability of n^2 / 2^33: 1e-6 for a hundred. Such two things draw
/// the same random numbers: their scatter is correlated, and no mean is wrong.
///
/// Source: FNV-1a, 32 bits (Fowler, Noll & Vo; RFC 9923). The random numbers themselves come from `Random`, so that
/// similar names need no dissimilar numbers.
constexpr std::uint32_t stream_of_name(std::string_view name) {
  std::uint32_t hash = 2166136261U;
  for (const char byte : name) hash = (hash ^ static_cast<unsigned char>(byte)) * 16777619U;
  return hash;
}

}  // namespace talus
