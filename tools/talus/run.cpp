#include <malloc.h>
#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "progress.hpp"
#include "run_support.hpp"
#include "talus/base/error.hpp"
#include "talus/io/hazard_file.hpp"
#include "talus/io/output_folder.hpp"
#include "talus/io/run_record.hpp"
#include "talus/io/write_crossings.hpp"
#include "talus/io/write_lines.hpp"
#include "talus/io/write_vectors.hpp"
#include "talus/products/maps.hpp"
#include "write_maps.hpp"

namespace {

using talus::io::LoadedScenario;

struct Options {
  talus::io::RunFlags flags;
  std::string out, progress;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

/// The files that are written while the trajectories are traced.
class Vectors {
 public:
  Vectors(const LoadedScenario& loaded, const std::filesystem::path& folder)
      : scenario_(loaded.scenario),
        folder_(folder),
        stops_(folder / "stops.gpkg", loaded),
        summary_(scenario_.screens.size()) {
    if (loaded.scenario.output.paths > 0)
      paths_.emplace(folder / "trajectories.gpkg", loaded.geo, loaded.scenario.surface.grid());
    if (!loaded.scenario.screens.empty()) crossings_.emplace(folder / "screens.csv", loaded.scenario, loaded.geo);
  }

  talus::Sinks sinks() {
    talus::Sinks sinks;
    sinks.stops = [this](std::span<const talus::StopRow> rows) { stops_.write(rows); };
    if (paths_) sinks.paths = [this](const talus::RecordedPath& path) { paths_->write(path); };
    if (crossings_)
      sinks.crossings = [this](std::span<const talus::Crossing> rows) {
        crossings_->write(rows);
        summary_.add(rows);
      };
    return sinks;
  }

  void finish(const talus::Totals& totals) {
    stops_.finish();
    if (paths_) paths_->finish();
    if (crossings_) {
      crossings_->finish();
      talus::io::write_text(folder_ / "screens_summary.csv", talus::io::screens_summary_csv(scenario_, summary_));
    }
    if (!scenario_.barriers.empty())
      talus::io::write_text(folder_ / "barriers.csv", talus::io::barriers_csv(scenario_, totals));
  }

 private:
  const talus::Scenario& scenario_;
  std::filesystem::path folder_;
  talus::io::StopsWriter stops_;
  std::optional<talus::io::TrajectoriesWriter> paths_;
  std::optional<talus::io::CrossingsWriter> crossings_;
  talus::ScreenSummary summary_;
};

/// What a user should know of the result.
std::vector<std::string> warnings_of(const talus::Totals& totals) {
  const std::uint64_t left = count_of(totals, talus::End::Left);
  if (static_cast<double>(left) <= 0.01 * static_cast<double>(totals.released)) return {};
  return {share_text(left, totals.released) + " of the trajectories (" + count_text(left) +
          ") left the DEM or met missing data: the maps do not show how far they go; a larger DEM would"};
}

void summarise(const talus::io::RunRecord& record, const LoadedScenario& loaded, const std::string& folder) {
  const talus::Totals& t = record.totals;
  say("", count_text(t.released) + " trajectories from " + count_text(loaded.scenario.sources.size()) +
              " source cells: " + ends_text(t));
  char seconds[96];
  std::snprintf(seconds, sizeof seconds, "read %.1f s, simulated %.1f s, wrote %.1f s", record.wall.read,
                record.wall.simulate, record.wall.write);
  say("", count_text(record.touched_cells) + " cells reached; " + seconds);
  say("", "results are in " + folder);
}

/// Traces, scores and writes everything into `folder`; fills the record.
void simulate_and_write(const Options& options, const LoadedScenario& loaded, const std::filesystem::path& folder,
                        Stopwatch& watch, talus::io::RunRecord& record) {
  const talus::Scenario& scenario = loaded.scenario;
  Progress progress(Progress::mode_of(options.quiet, options.progress == "machine"), scenario.released());
  talus::Tally tally(scenario.surface.grid(), scenario.output.energy_thresholds, scenario.output.height_thresholds);
  if (auto weights = talus::AnnualWeights::of(scenario)) tally.keep_hazard(std::move(*weights));
  Vectors vectors(loaded, folder);
  talus::Sinks sinks = vectors.sinks();
  sinks.progress = [&progress](double share) { return progress.update(share) && !interrupted(); };
  record.totals = talus::simulate(scenario, tally, sinks, record.threads);
  if (record.totals.interrupted || interrupted()) stop_interrupted();
  const Stopwatch::Lap simulated = watch.lap();
  record.touched_cells = tally.touched_cells();
  malloc_trim(0);  // gives back what the workers' batches took, before the maps need room

  progress.stage("writing the results");
  vectors.finish(record.totals);
  const talus::Grid& grid = scenario.surface.grid();
  write_maps(talus::make_maps(scenario, tally),
             {folder, loaded.geo, grid.columns, grid.rows, [] { return !interrupted(); }}, record.threads);
  if (tally.weights() != nullptr) talus::io::write_hazard(folder / talus::io::kHazardFile, loaded, tally);
  talus::io::write_text(folder / "scenario.toml", loaded.complete_toml);
  record.files = files_in(folder);
  const Stopwatch::Lap written = watch.lap();
  record.cpu.simulate = simulated.cpu - record.totals.sink_cpu_seconds;
  record.cpu.write = written.cpu + record.totals.sink_cpu_seconds;
  record.wall.simulate = simulated.wall;
  record.wall.write = written.wall;
  for (const std::string& warning : warnings_of(record.totals)) record.warnings.push_back(warning);
  talus::io::write_text(folder / "run.json", talus::io::run_json(record, loaded));
  progress.finish();
}

/// Says what went wrong where too many trajectories ended at a limit, and how to look into it.
int judge_limits(const talus::Totals& totals, const std::filesystem::path& folder) {
  if (!talus::io::too_many_limits(totals)) return 0;
  say("error", limits_text(totals) + "; look at the first: talus trace " + (folder / "scenario.toml").string() +
                   " --source " + std::to_string(totals.first_limit[0]) + " --block " +
                   std::to_string(totals.first_limit[1]));
  return 1;
}

int run(const Options& options) {
  Stopwatch watch;
  catch_signals();
  const LoadedScenario loaded = talus::io::load_scenario(options.flags);
  if (interrupted()) stop_interrupted();
  talus::io::OutputFolder folder(options.out, options.overwrite);
  for (const talus::io::InputFile& input : loaded.inputs)
    if (input.role != "scenario") folder.protect(input.path);
  if (!options.quiet)
    for (const std::string& warning : loaded.warnings) say("warning", warning);

  talus::io::RunRecord record;
  record.command = command_line();
  record.warnings = loaded.warnings;
  record.threads = options.threads > 0 ? options.threads : omp_get_num_procs();
  const Stopwatch::Lap read = watch.lap();
  record.cpu.read = read.cpu;
  record.wall.read = read.wall;
  simulate_and_write(options, loaded, folder.temporary(), watch, record);
  if (interrupted()) stop_interrupted();
  folder.commit();

  if (!options.quiet) {
    for (const std::string& warning : warnings_of(record.totals)) say("warning", warning);
    summarise(record, loaded, folder.final_path().string());
  }
  return judge_limits(record.totals, folder.final_path());
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
