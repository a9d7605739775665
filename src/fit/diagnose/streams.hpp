#pragma once
#include <cstdint>

#include "talus/fit/campaign/campaign.hpp"

namespace talus {

/// Stream of the random numbers of a block: a hash of its id (FNV-1a), so that neither its place in the file nor the
/// other blocks matter.
inline std::uint32_t stream_of(const MeasuredBlock& block) {
  std::uint32_t hash = 2166136261U;
  for (const char c : block.id) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

}  // namespace talus
