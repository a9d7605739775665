#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "talus/base/random.hpp"

namespace talus {

/// What a random number of a measured block decides, apart from its trajectories.
enum class BlockDraw : std::uint32_t {
  Weight,       ///< of the block in a bootstrap
  Trial,        ///< that stands in for the block's measurement
  Order,        ///< in which blocks are cut into folds
  RankOfTie,    ///< between the simulated values beside a measured one
  Permutation,  ///< its place among the blocks that hand each other their values
};

/// A random number of one block, in (0, 1). It depends on the block's stream alone: other blocks, and the order of all,
/// change nothing.
///
/// @param stream  MeasuredBlock::stream
/// @param number  of the draw: a bootstrap, a data set, an order
inline double draw_of_block(std::uint64_t seed, std::uint32_t stream, std::uint32_t number, BlockDraw what) {
  return uniform(Random(seed, stream, number, Purpose::Bootstrap).words(static_cast<std::uint32_t>(what))[0]);
}

/// The used blocks in random order number `number`: neighbours in a file are often of one day or one kind.
///
/// @param streams  of all blocks
/// @param used     by block
inline std::vector<std::size_t> random_order(std::span<const std::uint32_t> streams, const std::vector<bool>& used,
                                             std::uint64_t seed, std::uint32_t number) {
  std::vector<std::pair<double, std::size_t>> keyed;
  for (std::size_t b = 0; b < used.size(); ++b)
    if (used[b]) keyed.emplace_back(draw_of_block(seed, streams[b], number, BlockDraw::Order), b);
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::size_t> order;
  for (const auto& [key, block] : keyed) order.push_back(block);
  return order;
}

}  // namespace talus
