#include <omp.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "program.hpp"
#include "progress.hpp"
#include "run_results.hpp"
#include "run_session.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shared_memory.hpp"
#include "talus/base/text.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/simulate/tally/tally_exchange.hpp"

namespace fs = std::filesystem;

namespace {

using talus::io::LoadedScenario;
using talus::io::OutputFolder;

/// "I/N".
talus::Part part_of(const std::optional<std::string>& given) {
  talus::Part part;
  if (!given) return part;
  const std::string& text = *given;
  char end = '\0';
  if (std::sscanf(text.c_str(), "%9u/%9u%c", &part.number, &part.of, &end) != 2 || part.number < 1 ||
      part.number > part.of)
    throw talus::InputError("--part '" + text + "': must be I/N with I from 1 to N, for example 2/3");
  return part;
}

void check(const RunOptions& options) {
  if (options.rounds.until_error && options.part)
    throw talus::InputError(
        "--until-error with --part: one part cannot know the error of all; give every part the same --rounds, and "
        "talus merge says what was reached");
}

/// Blocks are numbered with 32 bits.
void check_number(const talus::Rounds& rounds, const talus::Scenario& scenario) {
  const std::uint32_t rounds_at_most = rounds.until_error ? rounds.most : rounds.count;
  if (std::uint64_t{scenario.trajectories} * rounds_at_most > 1'000'000'000)
    throw talus::InputError(
        std::to_string(rounds_at_most) + " rounds of trajectories = " + std::to_string(scenario.trajectories) +
        ": are more than 1e9 blocks of a source cell; give fewer --rounds, --most-rounds or --trajectories");
}

/// Writes the results of a whole run and gives them their name; the leader alone. Returns the exit code.
///
/// @param loaded  becomes the scenario with the trajectories of all rounds: OUT/scenario.toml says what was traced
int deliver(const RunOptions& options, LoadedScenario& loaded, RunSession& session, OutputFolder& folder, Stopwatch& watch,
            Progress& progress, talus::io::RunRecord& record) {
  const std::uint32_t rounds = session.rounds_done();
  session.tally().set_rounds(rounds);
  loaded.settings = session.checkpoint().settings(rounds);
  talus::io::set_rounds(loaded, rounds);
  try {
    write_results(loaded, session.checkpoints(), session.tally(), folder.temporary(), watch, progress, record);
  } catch (const Interrupted&) {
    session.interrupt_writing();
  }
  if (interrupted()) session.interrupt_writing();
  folder.commit();
  if (!options.quiet) summarise(record, loaded, loaded.warnings.size(), folder.final_path().string());
  return judge_limits(record.totals, folder.final_path());
}

/// The terrain is shared by the processes of a machine while this lives; with --memory each has it in a file.
class SharedTerrain {
 public:
  SharedTerrain(const RunOptions& options, talus::ProcessGroup& processes) {
    const std::string name = "talus-" + std::to_string(getpid()) + "-" + std::to_string(std::time(nullptr));
    if (processes.size() > 1 && options.memory.empty()) talus::SharedMemory::begin(processes.tell(name));
  }
  ~SharedTerrain() { talus::SharedMemory::end(); }
  SharedTerrain(const SharedTerrain&) = delete;
  SharedTerrain& operator=(const SharedTerrain&) = delete;
};

/// Reads and checks, the leader first: it tells what is wrong, and the others of its machine need not read the terrain.
LoadedScenario load(const RunOptions& options, std::size_t memory, talus::ProcessGroup& processes) {
  std::optional<LoadedScenario> loaded;
  const SharedTerrain sharing(options, processes);
  const auto read = [&] {
    if (memory > 0) talus::io::limit_memory(options.out, memory);
    loaded = talus::io::load_scenario(options.flags);
    check_number(options.rounds, loaded->scenario);
  };
  together(processes, [&] {
    if (processes.leads()) read();
  });
  together(processes, [&] {
    if (!processes.leads()) read();
  });
  return std::move(*loaded);
}

/// The exit code of the run or the part that --resume finds done, as a scheduler may ask for it again; nothing where it
/// is not. Throws InputError where what is there is a part of another plan.
std::optional<int> code_of_done(const RunOptions& options, const LoadedScenario& loaded, const talus::Part& part,
                                talus::ProcessGroup& processes) {
  std::optional<int> code;
  together(processes, [&] {
    if (!processes.leads() || !options.resume || options.overwrite) return;
    if (!options.part) {
      const auto status = talus::io::status_of_result(options.out, talus::io::plan_checksum(loaded), options.rounds);
      if (!status) return;
      code = *status == talus::io::kComplete ? kDone : kFailed;
      std::error_code ignored;  // a run that was killed at its very end may have left what it kept
      fs::remove_all(fs::path(options.out) / OutputFolder::kWork, ignored);
    } else if (fs::exists(fs::path(options.out) / talus::io::kCheckpointManifest)) {
      const auto checkpoint = talus::io::Checkpoint::opened(options.out, loaded, false);
      if (checkpoint.part().number == part.number && checkpoint.part().of == part.of && checkpoint.between_rounds() &&
          checkpoint.rounds() == options.rounds.count)
        code = kDone;
    }
  });
  const auto largest = static_cast<int>(processes.largest(code ? *code + 1 : 0));
  return largest > 0 ? std::optional(largest - 1) : std::nullopt;
}

std::unique_ptr<OutputFolder> folder_of(const RunOptions& options, const LoadedScenario& loaded, talus::ProcessGroup& processes) {
  std::unique_ptr<OutputFolder> folder;
  together(processes, [&] {
    if (!processes.leads()) return;
    folder = std::make_unique<OutputFolder>(
        options.out, options.overwrite,
        options.resume ? OutputFolder::Unfinished::Resume : OutputFolder::Unfinished::Refuse);
    for (const talus::io::InputFile& input : loaded.inputs)  // the scenario that the run itself left may be replaced
      if (fs::path(input.path) != folder->final_path() / "scenario.toml") folder->protect(input.path);
  });
  return folder;
}

/// Gives a part its name: what was kept of it is the result.
int deliver_part(const RunOptions& options, OutputFolder& folder, const talus::Totals& totals, Progress& progress) {
  folder.commit_work();
  progress.finish();
  if (!options.quiet)
    say("", "part " + *options.part + ": " + count_text(totals.released) + " trajectories; results are in " +
                folder.final_path().string() + "; talus merge joins the parts");
  return 0;
}

/// Does it. Where it fails (a full disk), says how to go on with what was kept.
void with_hint(RunSession& session, const std::function<void()>& what) {
  try {
    what();
  } catch (const Interrupted&) {
    throw;
  } catch (const talus::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    if (!session.is_kept()) throw;
    throw std::runtime_error(std::string(error.what()) + "; what was kept last goes on with: " + command_to_resume());
  }
}

void warn_of_input(const RunOptions& options, const LoadedScenario& loaded, const talus::Part& part) {
  for (const std::string& warning : loaded.warnings) say("warning", warning);
  const std::size_t sources = loaded.scenario.sources.size();
  if (options.part && part.first(sources) == part.end(sources))
    say("warning", "--part " + *options.part + " is empty: the plan has " + count_text(sources) + " source cells");
}

int run(const RunOptions& options, talus::ProcessGroup& processes) {
  Stopwatch watch;
  catch_signals();
  talus::Part part;
  std::size_t memory = 0;  // 0: no limit
  const int threads = options.threads > 0 ? options.threads : processes.size() > 1 ? 1 : omp_get_num_procs();
  together(processes, [&] {
    part = part_of(options.part);
    check(options);
    if (!options.memory.empty()) memory = memory_limit_of(options.memory, threads);
  });
  LoadedScenario loaded = load(options, memory, processes);
  if (processes.largest(interrupted() ? 1 : 0) > 0) stop_interrupted();
  if (const std::optional<int> code = code_of_done(options, loaded, part, processes)) {
    if (processes.leads() && *code != kDone)
      say("error", "the run is done, but too many trajectories ended at a limit: " + options.out);
    else if (processes.leads() && !options.quiet)
      say("", (options.part ? "part " + *options.part : "the run") + " is done: " + options.out);
    return *code;
  }
  const std::unique_ptr<OutputFolder> folder = folder_of(options, loaded, processes);
  if (!options.quiet && processes.leads()) warn_of_input(options, loaded, part);

  talus::io::RunRecord record;
  record.command = command_line();
  record.plan = talus::io::plan_checksum(loaded);
  record.warnings = loaded.warnings;
  record.threads = threads * processes.size();
  record.ranks = processes.size();
  Progress progress(Progress::mode_of(options.quiet || !processes.leads(), options.progress == "machine" && processes.leads()),
                    loaded.scenario.released());
  RunSession session(options, loaded, part, folder.get(), progress, processes);
  if (!options.quiet && processes.leads() && !session.checkpoint().empty())
    say("", "going on: " + count_text(session.traced()) + " trajectories were kept");
  const Stopwatch::Lap read = watch.lap();
  record.cpu.read = read.cpu;
  record.wall.read = read.wall;
  with_hint(session, [&] { session.trace(threads, progress); });
  const Stopwatch::Lap simulated = watch.lap();
  record.totals = session.totals();
  record.cpu.simulate = record.totals.cpu_seconds - record.totals.sink_cpu_seconds;
  record.wall.simulate = simulated.wall;
  if (options.rounds.several()) record.rounds = {session.rounds_done(), options.rounds, session.accuracy()};
  if (options.part) {
    session.keep();
  } else {
    session.keep_the_rest();
    talus::collect(session.tally(), processes);
  }
  int code = kDone;
  try {
    if (processes.leads())
      with_hint(session, [&] {
        code = options.part ? deliver_part(options, *folder, record.totals, progress)
                            : deliver(options, loaded, session, *folder, watch, progress, record);
      });
  } catch (const Interrupted& interruption) {  // the others wait to be told
    say("", interruption.what());
    code = kInterrupted;
  }
  return std::stoi(processes.tell(std::to_string(code)));
}

}  // namespace

void add_scenario_options(CLI::App& command, talus::io::RunFlags& flags) {
  command.add_option("scenario", flags.scenario, "scenario file (TOML)");
  command.add_option("--dem", flags.dem, "terrain: a raster in a projected system in metres");
  command.add_option("--sources", flags.sources, "where blocks start: polygons, lines or points");
  command.add_option("--preset", flags.preset, "parameter set of the ground; talus presets lists them");
  command.add_option("--diameter", flags.diameter, "of the blocks [m]");
  command.add_option("--trajectories", flags.trajectories, "per source cell");
  command.add_option("--seed", flags.seed, "of the random numbers");
}

void add_run(CLI::App& app, Action& action, talus::ProcessGroup& processes) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Simulate a scenario and write its hazard maps");
  add_scenario_options(*command, options->flags);
  command->add_option("-o,--out", options->out, "new folder for the results")->required();
  command->add_flag("--overwrite", options->overwrite, "replace the folder if it holds an earlier result");
  command
      ->add_option("--threads", options->threads,
                   "all processors where it is not given, of several processes one each; the results are the same")
      ->check(CLI::Range(1, 4096));
  command->add_option("--part", options->part, "I/N: only part I of N of the source cells, for talus merge");
  command->add_flag("--resume", options->resume, "go on with an interrupted run of the same command");
  command->add_option("--memory", options->memory, "such as 2G: what does not fit lies in a file beside the results");
  command
      ->add_option("--checkpoint", options->checkpoint, "seconds between two times that the work is kept on the disk")
      ->check(between(0.0, 1e6));
  command->add_option("--rounds", options->rounds.count, "how often the scenario's trajectories are traced")
      ->check(CLI::Range(1, 10'000));
  CLI::Option* until =
      command->add_option("--until-error", options->rounds.until_error,
                          "rounds until the relative 95 % half-width of the impact probability is below this");
  until->check(between(1e-4, 10.0))->excludes("--rounds");
  command->add_option("--above", options->rounds.above, "the error counts in all cells with a larger probability; 0.01")
      ->check(between(1e-9, 1.0));
  command->add_option("--most-rounds", options->rounds.most, "--until-error: never more; 100")
      ->check(CLI::Range(1, 10'000))
      ->needs(until);
  command->add_flag("-q,--quiet", options->quiet, "say nothing but errors");
  command->add_option("--progress", options->progress, "machine: lines `progress 42` for other programs")
      ->check(CLI::IsMember({"machine"}));
  command->footer(
      "Examples:\n"
      "  talus run scenario.toml -o result\n"
      "  talus run --dem dem.tif --sources cliffs.gpkg --diameter 1.2 --trajectories 100 -o result\n\n"
      "An option given here counts more than the scenario file. OUT/scenario.toml holds all settings.");
  command->callback([&action, &processes, options] { action = [options, &processes] { return run(*options, processes); }; });
}
