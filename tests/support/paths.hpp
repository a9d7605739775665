#pragma once
#include "talus/simulate/plan/plan.hpp"

namespace talus::test {

/// Calls `f` with every release of a scenario and its path, one after the other.
template <class F>
void for_each_path(const Scenario& s, F f) {
  Path path;
  for (std::uint32_t source = 0; source < s.sources.size(); ++source)
    for (std::uint32_t block = 0; block < s.trajectories; ++block) {
      const Release release = make_release(s, source, block);
      trace(s.world(), release, path);
      f(release, path);
    }
}

}  // namespace talus::test
