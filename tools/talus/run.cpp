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
#include "sitting.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shared_memory.hpp"
#include "talus/base/text.hpp"
#include "talus/io/hazard_file.hpp"
#include "talus/io/output_folder.hpp"
#include "talus/simulate/team_tally.hpp"

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
int deliver(const RunOptions& options, LoadedScenario& loaded, Sitting& sitting, OutputFolder& folder, Stopwatch& watch,
            Progress& progress, talus::io::RunRecord& record) {
  const std::uint32_t rounds = sitting.rounds_done();
  sitting.tally().set_rounds(rounds);
  loaded.settings = sitting.store().settings(rounds);
  talus::io::set_rounds(loaded, rounds);
  try {
    write_results(loaded, sitting.stores(), sitting.tally(), folder.temporary(), watch, progress, record);
  } catch (const Interrupted&) {
    sitting.interrupt_writing();
  }
  if (interrupted()) sitting.interrupt_writing();
  folder.commit();
  if (!options.quiet) summarise(record, loaded, loaded.warnings.size(), folder.final_path().string());
  return judge_limits(record.totals, folder.final_path());
}

/// The terrain is shared by the processes of a machine while this lives; with --memory each has it in a file.
class SharedTerrain {
 public:
  SharedTerrain(const RunOptions& options, talus::Team& team) {
    const std::string name = "talus-" + std::to_string(getpid()) + "-" + std::to_string(std::time(nullptr));
    if (team.size() > 1 && options.memory.empty()) talus::SharedMemory::begin(team.tell(name));
  }
  ~SharedTerrain() { talus::SharedMemory::end(); }
  SharedTerrain(const SharedTerrain&) = delete;
  SharedTerrain& operator=(const SharedTerrain&) = delete;
};

/// Reads and checks, the leader first: it tells what is wrong, and the others of its machine need not read the terrain.
LoadedScenario load(const RunOptions& options, std::size_t memory, talus::Team& team) {
  std::optional<LoadedScenario> loaded;
  const SharedTerrain sharing(options, team);
  const auto read = [&] {
    if (memory > 0) talus::io::limit_memory(options.out, memory);
    loaded = talus::io::load_scenario(options.flags);
    check_number(options.rounds, loaded->scenario);
  };
  together(team, [&] {
    if (team.leads()) read();
  });
  together(team, [&] {
    if (!team.leads()) read();
  });
  return std::move(*loaded);
}

/// The exit code of the run or the part that --resume finds done, as a scheduler may ask for it again; nothing where it
/// is not. Throws InputError where what is there is a part of another plan.
std::optional<int> code_of_done(const RunOptions& options, const LoadedScenario& loaded, const talus::Part& part,
                                talus::Team& team) {
  std::optional<int> code;
  together(team, [&] {
    if (!team.leads() || !options.resume || options.overwrite) return;
    if (!options.part) {
      const auto status = talus::io::status_of_result(options.out, talus::io::plan_checksum(loaded), options.rounds);
      if (!status) return;
      code = *status == talus::io::kComplete ? kDone : kFailed;
      std::error_code ignored;  // a run that was killed at its very end may have left what it kept
      fs::remove_all(fs::path(options.out) / OutputFolder::kWork, ignored);
    } else if (fs::exists(fs::path(options.out) / talus::io::kStoreManifest)) {
      const auto store = talus::io::Store::opened(options.out, loaded, false);
      if (store.part().number == part.number && store.part().of == part.of && store.between_rounds() &&
          store.rounds() == options.rounds.count)
        code = kDone;
    }
  });
  const auto largest = static_cast<int>(team.largest(code ? *code + 1 : 0));
  return largest > 0 ? std::optional(largest - 1) : std::nullopt;
}

std::unique_ptr<OutputFolder> folder_of(const RunOptions& options, const LoadedScenario& loaded, talus::Team& team) {
  std::unique_ptr<OutputFolder> folder;
  together(team, [&] {
    if (!team.leads()) return;
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
void with_hint(Sitting& sitting, const std::function<void()>& what) {
  try {
    what();
  } catch (const Interrupted&) {
    throw;
  } catch (const talus::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    if (!sitting.is_kept()) throw;
    throw std::runtime_error(std::string(error.what()) + "; what was kept last goes on with: " + command_to_resume());
  }
}

void warn_of_input(const RunOptions& options, const LoadedScenario& loaded, const talus::Part& part) {
  for (const std::string& warning : loaded.warnings) say("warning", warning);
  const std::size_t sources = loaded.scenario.sources.size();
  if (options.part && part.first(sources) == part.end(sources))
    say("warning", "--part " + *options.part + " is empty: the plan has " + count_text(sources) + " source cells");
}

int run(const RunOptions& options, talus::Team& team) {
  Stopwatch watch;
  catch_signals();
  talus::Part part;
  std::size_t memory = 0;  // 0: no limit
  const int threads = options.threads > 0 ? options.threads : team.size() > 1 ? 1 : omp_get_num_procs();
  together(team, [&] {
    part = part_of(options.part);
    check(options);
    if (!options.memory.empty()) memory = memory_limit_of(options.memory, threads);
  });
  LoadedScenario loaded = load(options, memory, team);
  if (team.largest(interrupted() ? 1 : 0) > 0) stop_interrupted();
  if (const std::optional<int> code = code_of_done(options, loaded, part, team)) {
    if (team.leads() && *code != kDone)
      say("error", "the run is done, but too many trajectories ended at a limit: " + options.out);
    else if (team.leads() && !options.quiet)
      say("", (options.part ? "part " + *options.part : "the run") + " is done: " + options.out);
    return *code;
  }
  const std::unique_ptr<OutputFolder> folder = folder_of(options, loaded, team);
  if (!options.quiet && team.leads()) warn_of_input(options, loaded, part);

  talus::io::RunRecord record;
  record.command = command_line();
  record.plan = talus::io::plan_checksum(loaded);
  record.warnings = loaded.warnings;
  record.threads = threads * team.size();
  record.ranks = team.size();
  Progress progress(Progress::mode_of(options.quiet || !team.leads(), options.progress == "machine" && team.leads()),
                    loaded.scenario.released());
  Sitting sitting(options, loaded, part, folder.get(), progress, team);
  if (!options.quiet && team.leads() && !sitting.store().empty())
    say("", "going on: " + count_text(sitting.traced()) + " trajectories were kept");
  const Stopwatch::Lap read = watch.lap();
  record.cpu.read = read.cpu;
  record.wall.read = read.wall;
  with_hint(sitting, [&] { sitting.trace(threads, progress); });
  const Stopwatch::Lap simulated = watch.lap();
  record.totals = sitting.totals();
  record.cpu.simulate = record.totals.cpu_seconds - record.totals.sink_cpu_seconds;
  record.wall.simulate = simulated.wall;
  if (options.rounds.several()) record.rounds = {sitting.rounds_done(), options.rounds, sitting.accuracy()};
  if (options.part) {
    sitting.keep();
  } else {
    sitting.keep_the_rest();
    talus::collect(sitting.tally(), team);
  }
  int code = kDone;
  try {
    if (team.leads())
      with_hint(sitting, [&] {
        code = options.part ? deliver_part(options, *folder, record.totals, progress)
                            : deliver(options, loaded, sitting, *folder, watch, progress, record);
      });
  } catch (const Interrupted& interruption) {  // the others wait to be told
    say("", interruption.what());
    code = kInterrupted;
  }
  return std::stoi(team.tell(std::to_string(code)));
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

void add_run(CLI::App& app, Action& action, talus::Team& team) {
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
  command->callback([&action, &team, options] { action = [options, &team] { return run(*options, team); }; });
}
