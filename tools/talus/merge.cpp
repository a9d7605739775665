#include <omp.h>

#include <algorithm>
#include <memory>

#include "commands.hpp"
#include "progress.hpp"
#include "run_results.hpp"
#include "talus/base/error.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/files/output_folder.hpp"
#include "write_maps.hpp"

namespace fs = std::filesystem;

namespace {

using talus::io::LoadedScenario;
using talus::io::Checkpoint;

struct Options {
  std::string out, memory;
  std::vector<std::string> parts;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

LoadedScenario scenario_of(const std::string& part) {
  const fs::path file = fs::path(part) / "scenario.toml";
  for (const fs::path& needed : {fs::path(part) / talus::io::kCheckpointManifest, file})
    if (!fs::exists(needed))
      throw talus::InputError(part + ": is no part of a run (it has no " + needed.filename().string() +
                              "); give the folders that talus run --part I/N has written");
  talus::io::RunFlags flags;
  flags.scenario = file.string();
  return talus::io::load_scenario(flags);
}

std::string name_of(const talus::Part& part) {
  return std::to_string(part.number) + "/" + std::to_string(part.of);
}

/// The parts in their order. Throws InputError where they are not one whole.
std::vector<Checkpoint> opened(const std::vector<std::string>& folders, const LoadedScenario& loaded) {
  std::vector<Checkpoint> checkpoints;
  for (const std::string& folder : folders) checkpoints.push_back(Checkpoint::opened(folder, loaded, false));
  std::ranges::sort(checkpoints, {}, [](const Checkpoint& checkpoint) { return checkpoint.part().number; });
  const Checkpoint& first = checkpoints.front();
  for (std::size_t i = 0; i < checkpoints.size(); ++i) {
    const std::string name = checkpoints[i].folder().string() + ": ";
    const talus::Part part = checkpoints[i].part();
    if (part.of != first.part().of)
      throw talus::InputError(name + "is part " + name_of(part) + ", another one is " + name_of(first.part()) +
                              "; must all be of one division");
    if (i > 0 && part.number == checkpoints[i - 1].part().number)
      throw talus::InputError(name + "is part " + name_of(part) + ", and so is " + checkpoints[i - 1].folder().string() +
                              "; give each part once");
    if (!checkpoints[i].between_rounds() || checkpoints[i].rounds() != first.rounds())
      throw talus::InputError(name + "has " + std::to_string(checkpoints[i].rounds()) + " rounds, another part " +
                              std::to_string(first.rounds()) + "; run all parts with the same --rounds");
  }
  if (checkpoints.size() != first.part().of) {
    std::uint32_t missing = 1;
    while (missing <= checkpoints.size() && checkpoints[missing - 1].part().number == missing) ++missing;
    throw talus::InputError(std::to_string(checkpoints.size()) + " of " + std::to_string(first.part().of) +
                            " parts are given, part " + std::to_string(missing) +
                            " is the first that is not; give all");
  }
  return checkpoints;
}

int merge(const Options& options) {
  Stopwatch watch;
  catch_signals();
  const int threads = options.threads > 0 ? options.threads : omp_get_num_procs();
  if (!options.memory.empty())
    talus::io::limit_memory(options.out, memory_limit_of(options.memory, std::min(threads, kMapsAtOnce)));
  LoadedScenario loaded = scenario_of(options.parts.front());
  const std::vector<Checkpoint> checkpoints = opened(options.parts, loaded);
  talus::io::OutputFolder folder(options.out, options.overwrite);
  for (const std::string& part : options.parts) folder.protect(fs::path(part) / talus::io::kCheckpointManifest);
  for (const talus::io::InputFile& input : loaded.inputs) folder.protect(input.path);
  const talus::Scenario& scenario = loaded.scenario;
  talus::Tally tally(scenario.surface.grid(), scenario.output.energy_thresholds, scenario.output.height_thresholds);
  if (auto weights = talus::AnnualWeights::of(scenario, checkpoints.front().asked().several()))
    tally.keep_hazard(std::move(*weights));
  talus::io::RunRecord record;
  record.command = command_line();
  record.plan = talus::io::plan_checksum(loaded);
  record.warnings = loaded.warnings;
  record.threads = threads;
  record.parts = static_cast<std::uint32_t>(checkpoints.size());
  record.totals.barriers = talus::BarrierTally(scenario.barriers);
  Progress progress(Progress::mode_of(options.quiet, false), 0);
  for (const Checkpoint& checkpoint : checkpoints) {
    if (interrupted()) stop_interrupted();
    add(record.totals, checkpoint.add_to(tally));
  }
  const std::uint32_t rounds = checkpoints.front().rounds();
  if (rounds > 1) {
    record.rounds = {rounds, {}, {}};
    record.rounds.asked.count = rounds;
    record.rounds.reached = talus::accuracy_of(tally, record.totals.released, record.rounds.asked.above);
  }
  tally.set_rounds(rounds);
  loaded.settings = checkpoints.front().settings(rounds);
  talus::io::set_rounds(loaded, rounds);
  record.wall.read = watch.lap().wall;
  record.cpu.simulate = record.totals.cpu_seconds - record.totals.sink_cpu_seconds;
  write_results(loaded, checkpoints, tally, folder.temporary(), watch, progress, record);
  if (interrupted()) stop_interrupted();
  folder.commit();
  if (!options.quiet) summarise(record, loaded, 0, folder.final_path().string());
  return judge_limits(record.totals, folder.final_path());
}

}  // namespace

void add_merge(CLI::App& app, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("merge", "Join the parts of a run; the same bits as one run");
  command->add_option("out", options->out, "new folder for the results")->required();
  command->add_option("parts", options->parts, "folders that talus run --part I/N has written, all of them")
      ->required();
  command->add_option("--memory", options->memory, "such as 2G: what does not fit lies in a file beside the results");
  command->add_flag("--overwrite", options->overwrite, "replace the folder if it holds an earlier result");
  command->add_option("--threads", options->threads, "all processors where it is not given; the results are the same")
      ->check(CLI::Range(1, 4096));
  command->add_flag("-q,--quiet", options->quiet, "say nothing but errors");
  command->footer(
      "Example:\n"
      "  talus run scenario.toml --part 1/2 -o part1\n"
      "  talus run scenario.toml --part 2/2 -o part2\n"
      "  talus merge result part1 part2");
  command->callback([&action, options] { action = [options] { return merge(*options); }; });
}
