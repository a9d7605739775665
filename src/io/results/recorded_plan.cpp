#include "talus/io/results/recorded_plan.hpp"

#include <cstdint>
#include <optional>

#include "io/files/checksum.hpp"
#include "io/files/json.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/scenario/plan_checksum.hpp"
#include "talus/products/accuracy.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

/// The plan that a run or a part was of.
struct RecordedPlan {
  std::string checksum;  // of one round
  std::uint32_t rounds = 1;
  std::string record;  // name of the file that says so
  std::string folder;  // where it lay when it was written; empty: not known
  std::vector<InputFile> inputs = {};
};

std::vector<InputFile> inputs_of(const Json& record) {
  std::vector<InputFile> inputs;
  for (const Json& one : record.value("inputs", Json::array()))
    inputs.push_back({one.at("role"), one.at("path"), one.value("sha256", ""), {}});
  return inputs;
}

/// Reads the scenario of a plan with the files that it was of: where they were, or else beside the results, if these
/// have been moved or copied since. Throws InputError if these are others now.
LoadedScenario load_same(const std::string& scenario, const RecordedPlan& plan) {
  RunFlags flags;
  flags.scenario = scenario;
  flags.recorded.folder = plan.folder;
  const fs::path now = fs::absolute(scenario).lexically_normal().parent_path();
  const bool elsewhere = !plan.folder.empty() && fs::path(plan.folder) != now;
  std::vector<std::string> changed;
  for (const bool beside_first : {false, true}) {
    if (beside_first && !elsewhere) break;
    flags.recorded.beside_first = beside_first;
    LoadedScenario loaded = load_scenario(flags);
    changed = changed_inputs(plan.inputs, loaded.inputs);
    if (plan_checksum(loaded, plan.rounds) == plan.checksum) return loaded;
  }
  const std::string what = plan.inputs.empty() ? ""
                           : changed.empty()   ? " (a setting, or it was written by another version)"
                                               : " (" + listed(changed) + ")";
  throw InputError(scenario + ": it, or a file that it names, has changed since the run" + what +
                   ", so that the run cannot be repeated; run again (the checksums are in " + plan.record + ")");
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
      RecordedPlan plan{json.at("plan"), 1, name, json.value("folder", ""), inputs_of(json)};
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
  const std::optional<RecordedPlan> recorded = plan_in(folder);
  return load_same((folder / "scenario.toml").string(), {plan, 1, "run.json", recorded ? recorded->folder : "",
                                                         recorded ? recorded->inputs : std::vector<InputFile>()});
}

LoadedScenario recorded_or_own_plan(const std::string& scenario) {
  const fs::path file(scenario);
  if (file.filename() == "scenario.toml")
    if (const auto plan = plan_in(file.parent_path())) return load_same(scenario, *plan);
  RunFlags flags;
  flags.scenario = scenario;
  return load_scenario(flags);
}

}  // namespace talus::io
