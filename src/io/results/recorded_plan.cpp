#include "talus/io/results/recorded_plan.hpp"

#include <cstdint>
#include <optional>

#include "io/files/json.hpp"
#include "talus/base/error.hpp"
#include "talus/io/scenario/plan_checksum.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t kMostRounds = 1'000'000'000;

/// The plan that a run or a part was of.
struct RecordedPlan {
  std::string checksum;  // of one round
  std::uint32_t rounds = 1;
  std::string record;  // name of the file that says so
  std::string folder;  // where it lay when it was written; empty: not known
};

LoadedScenario load(const std::string& file, const std::optional<RecordedPlan>& plan) {
  RunFlags flags;
  flags.scenario = file;
  if (plan) flags.recorded_in = plan->folder;
  return load_scenario(flags);
}

void require_same(const LoadedScenario& loaded, const RecordedPlan& plan, const std::string& scenario) {
  if (plan_checksum(loaded, plan.rounds) == plan.checksum) return;
  throw InputError(scenario +
                   ": it, or a file that it names, has changed since the run, so that the run cannot be repeated; run "
                   "again (the checksums are in " +
                   plan.record + ")");
}

/// What the record of a run or part says; nothing if there is none, or one without a plan.
std::optional<RecordedPlan> plan_in(const fs::path& folder) {
  for (const char* const name : {"run.json", "part.json"}) {
    const fs::path file = folder / name;
    std::error_code none;
    if (!fs::exists(file, none)) continue;
    const auto read = [&]() -> std::optional<RecordedPlan> {
      const Json json = read_record(file);
      if (!json.contains("plan")) return std::nullopt;
      RecordedPlan plan{json.at("plan"), 1, name, json.value("folder", "")};
      if (plan.record == "run.json" && json.contains("rounds"))  // the scenario of a part is that of one round
        plan.rounds = static_cast<std::uint32_t>(whole_number(json["rounds"].at("done"), 1, kMostRounds));
      return plan;
    };
    return understood(file,
                      "so that nobody can say whether the scenario beside it is still that of the run; copy the "
                      "scenario into another folder to use it all the same",
                      read);
  }
  return std::nullopt;
}

}  // namespace

LoadedScenario recorded_plan(const fs::path& folder, const std::string& plan) {
  const std::string scenario = (folder / "scenario.toml").string();
  LoadedScenario loaded = load(scenario, plan_in(folder));
  require_same(loaded, {plan, 1, "run.json", {}}, scenario);
  return loaded;
}

LoadedScenario recorded_or_own_plan(const std::string& scenario) {
  const fs::path file(scenario);
  std::optional<RecordedPlan> plan;
  if (file.filename() == "scenario.toml") plan = plan_in(file.parent_path());
  LoadedScenario loaded = load(scenario, plan);
  if (plan) require_same(loaded, *plan, scenario);
  return loaded;
}

}  // namespace talus::io
