#include "talus/run/merge.hpp"

#include <omp.h>

#include <algorithm>
#include <span>

#include "results.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/scenario/plan_checksum.hpp"
#include "talus/run/memory_limit.hpp"
#include "talus/simulate/tally_of.hpp"

namespace talus::run {

namespace fs = std::filesystem;

namespace {

using io::LoadedScenario;

void require_parts(const std::vector<std::string>& folders) {
  for (const std::string& part : folders)
    for (const char* needed : {kCheckpointManifest, "scenario.toml"})
      if (!fs::exists(fs::path(part) / needed))
        throw InputError(part + ": is no part of a run (it has no " + needed +
                         "); give the folders that talus run --part I/N has written");
}

/// The plan of the parts, by the first of them whose inputs can be read here: those of others may be on other machines.
LoadedScenario scenario_of(std::span<const std::string> parts, MemoryPolicy memory, int threads) {
  io::RunFlags flags;
  flags.scenario = (fs::path(parts.front()) / "scenario.toml").string();
  try {
    return io::load_scenario(flags, nullptr, {memory}, threads);
  } catch (const InputError&) {
    if (parts.size() == 1) throw;
  }
  return scenario_of(parts.subspan(1), memory, threads);
}

/// "3 rounds (--above 0.01)"; of one round only that.
std::string asked_text(const Rounds& asked) {
  if (!asked.several()) return "1 round";
  return std::to_string(asked.at_most()) + " rounds (--above " + text_of(asked.above) + ")";
}

/// The parts in their order. Throws InputError unless every part of one division is there once, with equal rounds.
std::vector<Checkpoint> opened(const std::vector<std::string>& folders, const LoadedScenario& loaded) {
  std::vector<Checkpoint> checkpoints;
  for (const std::string& folder : folders) checkpoints.push_back(Checkpoint::opened(folder, loaded, false));
  std::ranges::sort(checkpoints, {}, [](const Checkpoint& checkpoint) { return checkpoint.part().number; });
  const Checkpoint& first = checkpoints.front();
  for (std::size_t i = 0; i < checkpoints.size(); ++i) {
    const std::string name = checkpoints[i].folder().string() + ": ";
    const Part part = checkpoints[i].part();
    if (part.of != first.part().of)
      throw InputError(name + "is part " + name_of(part) + ", another one is " + name_of(first.part()) +
                       "; must all be of one division");
    if (i > 0 && part.number == checkpoints[i - 1].part().number)
      throw InputError(name + "is part " + name_of(part) + ", and so is " + checkpoints[i - 1].folder().string() +
                       "; give each part once");
    if (!checkpoints[i].between_rounds() || checkpoints[i].rounds() != first.rounds())
      throw InputError(name + "has " + std::to_string(checkpoints[i].rounds()) + " rounds, another part " +
                       std::to_string(first.rounds()) + "; run all parts with the same --rounds");
    if (checkpoints[i].asked() != first.asked())  // with other rounds their weights have other units
      throw InputError(name + "was to have " + asked_text(checkpoints[i].asked()) + ", another part " +
                       asked_text(first.asked()) + "; run all parts with the same --rounds and --above, to their end");
  }
  if (checkpoints.size() != first.part().of) {
    std::uint32_t missing = 1;
    while (missing <= checkpoints.size() && checkpoints[missing - 1].part().number == missing) ++missing;
    throw InputError(std::to_string(checkpoints.size()) + " of " + std::to_string(first.part().of) +
                     " parts are given, part " + std::to_string(missing) + " is the first that is not; give all");
  }
  return checkpoints;
}

void protect_inputs(const io::OutputFolder& folder, const MergeRequest& request, const LoadedScenario& loaded) {
  for (const std::string& part : request.parts) folder.protect(fs::path(part) / kCheckpointManifest);
  for (const io::InputFile& input : loaded.inputs) folder.protect(input.path);
}

io::RunRecord new_record(const MergeRequest& request, const LoadedScenario& loaded, int threads) {
  io::RunRecord record;
  record.command = request.command;
  record.plan = io::plan_checksum(loaded);
  record.threads = threads;
  record.parts = static_cast<std::uint32_t>(request.parts.size());
  record.totals.barriers = BarrierTally(loaded.scenario.barriers);
  return record;
}

}  // namespace

Outcome merge(const MergeRequest& request, Observer& observer) {
  Stopwatch watch;
  const int threads = request.threads > 0 ? request.threads : omp_get_num_procs();
  const std::unique_ptr<ScratchFile> scratch =
      scratch_file_beside(request.out, memory_limit_of(request.memory, threads));
  const MemoryPolicy memory(scratch.get());
  require_parts(request.parts);
  LoadedScenario loaded = scenario_of(request.parts, memory, threads);
  const std::vector<Checkpoint> checkpoints = opened(request.parts, loaded);
  observer.inputs_read();
  io::OutputFolder folder(request.out, request.overwrite);
  protect_inputs(folder, request, loaded);
  say_later_results(folder, observer);
  const Scenario& scenario = loaded.scenario;
  Tally tally = tally_of(scenario, checkpoints.front().asked().at_most(), memory);
  io::RunRecord record = new_record(request, loaded, threads);
  observer.begin(0);
  for (const Checkpoint& checkpoint : checkpoints) {
    if (observer.interrupted()) stop_interrupted();
    add(record.totals, checkpoint.add_to(tally));
  }
  const std::uint32_t rounds = checkpoints.front().rounds();
  if (rounds > 1) {
    record.rounds = {rounds, {}, {}};
    record.rounds.asked.count = rounds;
    record.rounds.asked.above = checkpoints.front().asked().above;
    record.rounds.reached = accuracy_of(tally, record.totals.released, record.rounds.asked.above);
  }
  tally.set_rounds(rounds);
  checkpoints.front().recall(loaded, rounds);
  record.warnings = loaded.warnings;
  io::set_rounds(loaded, rounds);
  record.wall.read = watch.lap().wall;
  record.cpu.simulate = record.totals.cpu_seconds - record.totals.sink_cpu_seconds;
  write_results({loaded, checkpoints, tally, folder.temporary(), folder.final_path()}, observer, watch, record);
  if (observer.interrupted()) stop_interrupted();
  folder.commit();
  summarise(record, loaded, 0, folder.final_path(), observer);
  return judge_limits(record.totals, folder.final_path(), observer);
}

}  // namespace talus::run
