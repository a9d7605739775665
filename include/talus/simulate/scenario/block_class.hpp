#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// Sum of the weights of all classes.
double total_weight(std::span<const BlockClass> classes);

/// Index of the class at a share, 0..1, of the sum of all weights; 0 if there are no classes.
std::size_t class_at(const std::vector<BlockClass>& classes, double share);

/// Index of the block's class in `blocks.classes`; 0 if there are no classes.
std::size_t class_of_block(const Scenario& scenario, std::uint32_t source, std::uint32_t block);

}  // namespace talus
