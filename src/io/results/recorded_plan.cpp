#include "talus/io/results/recorded_plan.hpp"

#include "talus/base/error.hpp"
#include "talus/io/scenario/plan_checksum.hpp"

namespace talus::io {

LoadedScenario recorded_plan(const std::filesystem::path& folder, const std::string& plan) {
  RunFlags flags;
  flags.scenario = (folder / "scenario.toml").string();
  LoadedScenario loaded = load_scenario(flags);
  if (plan_checksum(loaded) != plan)
    throw InputError(flags.scenario +
                     ": it, or a file that it names, has changed since the run, so that the run "
                     "cannot be repeated; run again (the checksums are in run.json)");
  return loaded;
}

}  // namespace talus::io
