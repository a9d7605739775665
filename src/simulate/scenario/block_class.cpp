#include "talus/simulate/scenario/block_class.hpp"

namespace talus {

double total_weight(std::span<const BlockClass> classes) {
  double total = 0.0;
  for (const BlockClass& c : classes) total += c.weight;
  return total;
}

std::size_t class_at(const std::vector<BlockClass>& classes, double share) {
  const double total = total_weight(classes);
  double below = 0.0;
  for (std::size_t i = 0; i + 1 < classes.size(); ++i) {
    below += classes[i].weight;
    if (share * total < below) return i;
  }
  return classes.empty() ? 0 : classes.size() - 1;
}

std::size_t class_of_block(const Scenario& scenario, std::uint32_t source, std::uint32_t block) {
  const Random random(scenario.seed, source, block, Purpose::Release);
  return class_at(scenario.blocks.classes, uniform(random.words(1)[0]));
}

}  // namespace talus
