#pragma once
#include <string>
#include <vector>

#include "talus/simulate/scenario/scenario.hpp"

namespace talus {

/// An effect that is on: one of its strengths differs from its off value.
struct EffectUse {
  const EffectEntry* entry = nullptr;
  std::uint64_t cells = 0;  ///< with a height, in which it acts; of a list of trees: in which trees stand
  std::string text;         ///< where it acts, with its numbers, in one line
  std::string idle;         ///< why it does nothing in this scenario, in one line; empty: it acts

  bool acts() const { return idle.empty(); }
};

/// The effects of a scenario that are on, in the order of the registry. One does nothing on other days than that of the
/// run, on blocks that are spheres, and where its area has no cell, or no forest. The scenario must be valid.
std::vector<EffectUse> effects_in_use(const Scenario& scenario);

}  // namespace talus
