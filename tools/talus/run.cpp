#include <omp.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "progress.hpp"
#include "run_results.hpp"
#include "talus/base/error.hpp"
#include "talus/io/hazard_file.hpp"
#include "talus/io/output_folder.hpp"
#include "talus/products/accuracy.hpp"

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;
using talus::io::LoadedScenario;
using talus::io::OutputFolder;

struct Options {
  talus::io::RunFlags flags;
  std::string out, progress, part;
  talus::Rounds rounds;
  std::string memory;
  double checkpoint = 30.0;
  int threads = 0;
  bool overwrite = false, resume = false, quiet = false;
};

/// "I/N".
talus::Part part_of(const std::string& text) {
  talus::Part part;
  if (text.empty()) return part;
  char end = '\0';
  if (std::sscanf(text.c_str(), "%9u/%9u%c", &part.number, &part.of, &end) != 2 || part.number < 1 ||
      part.number > part.of)
    throw talus::InputError("--part '" + text + "': must be I/N with I from 1 to N, for example 2/3");
  return part;
}

void check(const Options& options, const talus::Part& part) {
  if (options.rounds.until_error && !part.whole())
    throw talus::InputError(
        "--until-error with --part: one part cannot know the error of all; give every part the same --rounds, and "
        "talus "
        "merge says what was reached");
}

/// The simulation of one command, with what it keeps on the disk.
class Sitting {
 public:
  Sitting(const Options& options, const LoadedScenario& loaded, const talus::Part& part, OutputFolder& folder,
          Progress& progress)
      : options_(options),
        scenario_(loaded.scenario),
        folder_(folder),
        tally_(scenario_.surface.grid(), scenario_.output.energy_thresholds, scenario_.output.height_thresholds),
        stores_(store_in(folder, loaded, part, options)),
        sinks_(store().sinks()),
        simulation_(scenario_, part, options.rounds.several(), tally_, sinks_) {
    if (auto weights = talus::AnnualWeights::of(scenario_, options.rounds.several()))
      tally_.keep_hazard(std::move(*weights));
    store().restore(simulation_, tally_);
    sinks_.progress = [&progress](double share) { return progress.update(share) && !interrupted(); };
    sinks_.pause = [this] { return seconds_since_kept() > options_.checkpoint; };
  }

  talus::io::Store& store() { return stores_.front(); }
  std::span<const talus::io::Store> stores() const { return stores_; }
  talus::Tally& tally() { return tally_; }
  const talus::Totals& totals() const { return simulation_.totals(); }
  std::uint32_t rounds_done() const { return simulation_.position().round + (simulation_.round_done() ? 1U : 0U); }

  /// Traces all rounds. Throws `Interrupted`, after what is done was kept.
  void trace(int threads, Progress& progress) {
    while (!enough()) {
      if (simulation_.round_done()) simulation_.next_round();
      if (options_.rounds.several() && simulation_.position().unit == 0)
        progress.begin("round " + std::to_string(simulation_.position().round + 1));
      simulation_.advance(threads);
      if (simulation_.totals().interrupted || interrupted()) interrupt();
      if (simulation_.round_done()) store().end_round(simulation_.position().round);
      if (seconds_since_kept() > options_.checkpoint) keep();
    }
  }

  void keep() {
    store().keep(simulation_, tally_);
    folder_.keep();
    kept_ = Clock::now();
  }

  /// Keeps what was traced and throws `Interrupted`, which says how to go on.
  [[noreturn]] void interrupt() {
    if (simulation_.position().unit == 0 && simulation_.position().round == 0) stop_interrupted();
    keep();
    std::string again;
    for (const std::string& word : command_line())
      if (word != "--resume") again += (again.empty() ? "" : " ") + word;
    throw Interrupted("interrupted; what was traced is kept, go on with: " + again + " --resume");
  }

  /// What `--until-error` asks of the cells, so far.
  talus::Accuracy accuracy() const {
    return talus::accuracy_of(tally_, std::uint64_t{rounds_done()} * scenario_.released(), options_.rounds.above);
  }

 private:
  static std::vector<talus::io::Store> store_in(OutputFolder& folder, const LoadedScenario& loaded,
                                                const talus::Part& part, const Options& options) {
    std::vector<talus::io::Store> stores;
    folder.hold_work();
    if (fs::exists(folder.work() / talus::io::kStoreManifest)) {
      stores.push_back(talus::io::Store::opened(folder.work(), loaded, true));
      const talus::Rounds& asked = options.rounds;
      if (stores.front().further_rounds() != asked.several() ||
          (!asked.until_error && stores.front().rounds() > asked.count))
        throw talus::InputError(options.out + ": what is kept there was begun with other --rounds or --until-error (" +
                                std::to_string(stores.front().rounds()) +
                                " rounds are done); give the same, or begin anew (--overwrite)");
      const talus::Part kept = stores.front().part();
      if (kept.number != part.number || kept.of != part.of)
        throw talus::InputError(options.out + ": what is kept there is part " + std::to_string(kept.number) + "/" +
                                std::to_string(kept.of) + "; give that with --part, or another folder");
    } else {
      stores.emplace_back(folder.work(), loaded, part, options.rounds.several());
    }
    return stores;
  }

  double seconds_since_kept() const { return std::chrono::duration<double>(Clock::now() - kept_).count(); }

  bool enough() const {
    const talus::Rounds& wanted = options_.rounds;
    const std::uint32_t done = rounds_done();
    if (done == 0) return false;
    if (!simulation_.round_done() && simulation_.position().unit > 0) return false;
    if (!wanted.until_error) return done >= wanted.count;
    return done >= wanted.most || accuracy().half_width < *wanted.until_error;
  }

  const Options& options_;
  const talus::Scenario& scenario_;
  OutputFolder& folder_;
  talus::Tally tally_;
  std::vector<talus::io::Store> stores_;  // one
  talus::Sinks sinks_;
  talus::Simulation simulation_;
  Clock::time_point kept_ = Clock::now();
};

/// The scenario with the trajectories of all rounds, so that OUT/scenario.toml says what was traced.
LoadedScenario with_rounds(const talus::io::RunFlags& flags, const talus::io::Store& store,
                           const LoadedScenario& before) {
  talus::io::RunFlags all = flags;
  all.trajectories = before.scenario.trajectories * store.rounds();
  LoadedScenario loaded = talus::io::load_scenario(all);
  talus::io::refuse_changed_inputs(before, loaded);
  loaded.settings = store.settings(store.rounds());
  return loaded;
}

/// Blocks are numbered with 32 bits.
void check_number(const talus::Rounds& rounds, const talus::Scenario& scenario) {
  const std::uint32_t rounds_at_most = rounds.until_error ? rounds.most : rounds.count;
  if (std::uint64_t{scenario.trajectories} * rounds_at_most > 1'000'000'000)
    throw talus::InputError(
        std::to_string(rounds_at_most) + " rounds of trajectories = " + std::to_string(scenario.trajectories) +
        ": are more than 1e9 blocks of a source cell; give fewer --rounds, --most-rounds or --trajectories");
}

/// Writes the results of a whole run and gives them their name. Returns the exit code.
int deliver(const Options& options, const LoadedScenario& loaded, Sitting& sitting, OutputFolder& folder,
            Stopwatch& watch, Progress& progress, talus::io::RunRecord& record) {
  const std::uint32_t rounds = sitting.rounds_done();
  sitting.tally().set_rounds(rounds);
  const std::optional<LoadedScenario> all =
      rounds > 1 ? std::optional(with_rounds(options.flags, sitting.store(), loaded)) : std::nullopt;
  const LoadedScenario& whole = all ? *all : loaded;
  try {
    write_results(whole, sitting.stores(), sitting.tally(), folder.temporary(), watch, progress, record);
  } catch (const Interrupted&) {
    sitting.interrupt();
  }
  if (interrupted()) sitting.interrupt();
  folder.commit();
  if (!options.quiet) summarise(record, whole, loaded.warnings.size(), folder.final_path().string());
  return judge_limits(record.totals, folder.final_path());
}

int run(const Options& options) {
  Stopwatch watch;
  catch_signals();
  const talus::Part part = part_of(options.part);
  check(options, part);
  if (!options.memory.empty()) talus::io::limit_memory(options.out, bytes_of(options.memory));
  const LoadedScenario loaded = talus::io::load_scenario(options.flags);
  if (interrupted()) stop_interrupted();
  check_number(options.rounds, loaded.scenario);
  OutputFolder folder(options.out, options.overwrite,
                      options.resume ? OutputFolder::Unfinished::Resume : OutputFolder::Unfinished::Refuse);
  for (const talus::io::InputFile& input : loaded.inputs)  // the scenario that the run itself left may be replaced
    if (fs::path(input.path) != folder.final_path() / "scenario.toml") folder.protect(input.path);
  if (!options.quiet)
    for (const std::string& warning : loaded.warnings) say("warning", warning);

  talus::io::RunRecord record;
  record.command = command_line();
  record.warnings = loaded.warnings;
  record.threads = options.threads > 0 ? options.threads : omp_get_num_procs();
  Progress progress(Progress::mode_of(options.quiet, options.progress == "machine"), loaded.scenario.released());
  Sitting sitting(options, loaded, part, folder, progress);
  const Stopwatch::Lap read = watch.lap();
  record.cpu.read = read.cpu;
  record.wall.read = read.wall;
  sitting.trace(record.threads, progress);
  const Stopwatch::Lap simulated = watch.lap();
  record.totals = sitting.totals();
  record.cpu.simulate = record.totals.cpu_seconds - record.totals.sink_cpu_seconds;
  record.wall.simulate = simulated.wall;
  if (options.rounds.several()) record.rounds = {sitting.rounds_done(), options.rounds, sitting.accuracy()};

  if (!part.whole()) {
    sitting.keep();  // the files of the store are the results
    folder.commit_work();
    progress.finish();
    if (!options.quiet)
      say("", "part " + options.part + ": " + count_text(record.totals.released) + " trajectories; results are in " +
                  folder.final_path().string() + "; talus merge joins the parts");
    return 0;
  }
  return deliver(options, loaded, sitting, folder, watch, progress, record);
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

void add_run(CLI::App& app, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("run", "Simulate a scenario and write its hazard maps");
  add_scenario_options(*command, options->flags);
  command->add_option("-o,--out", options->out, "new folder for the results")->required();
  command->add_flag("--overwrite", options->overwrite, "replace the folder if it holds an earlier result");
  command->add_option("--threads", options->threads, "all processors where it is not given; the results are the same")
      ->check(CLI::Range(1, 4096));
  command->add_option("--part", options->part, "I/N: only part I of N of the source cells, for talus merge");
  command->add_flag("--resume", options->resume, "go on with an interrupted run of the same command");
  command->add_option("--memory", options->memory, "such as 2G: what does not fit lies in a file beside the results");
  command
      ->add_option("--checkpoint", options->checkpoint, "seconds between two times that the work is kept on the disk")
      ->check(CLI::Range(0.0, 1e6));
  command->add_option("--rounds", options->rounds.count, "how often the scenario's trajectories are traced")
      ->check(CLI::Range(1, 10'000));
  CLI::Option* until =
      command->add_option("--until-error", options->rounds.until_error,
                          "rounds until the relative 95 % half-width of the impact probability is below this");
  until->check(CLI::Range(1e-4, 10.0))->excludes("--rounds");
  command->add_option("--above", options->rounds.above, "the error counts in all cells with a larger probability; 0.01")
      ->check(CLI::Range(1e-9, 1.0));
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
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}
