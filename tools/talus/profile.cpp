#include <omp.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "progress.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/reports/profile_plot.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/io/results/write_crossings.hpp"
#include "talus/io/results/write_profile.hpp"
#include "talus/run/stopwatch.hpp"
#include "talus/run/summary.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/presets.hpp"
#include "talus/simulate/simulate.hpp"
#include "talus/simulate/tally_of.hpp"

namespace {

namespace fs = std::filesystem;
using talus::io::LoadedProfile;
using talus::run::profile_warnings;
using talus::run::Stopwatch;

constexpr std::uint32_t kDrawn = 60;  // paths in the drawing
constexpr double kPathSpacing = 1.0;  // largest distance between written points of a flight [m]

struct ProfileOptions {
  talus::io::ProfileFlags flags;
  std::string out, progress;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

/// Passes what `simulate` hands out to the files and the counters.
class Readers {
 public:
  Readers(const LoadedProfile& profile, const fs::path& folder)
      : writer_(folder, profile),
        bins_(profile.loaded.scenario.surface.grid().columns - 1, profile.step, profile.bin),
        runout_(profile.bin),
        every_(std::max<std::uint64_t>(
            1, std::min<std::uint64_t>(profile.loaded.scenario.output.paths, profile.loaded.scenario.released()) /
                   kDrawn)) {
    const talus::Scenario& scenario = profile.loaded.scenario;
    if (!scenario.screens.empty()) crossings_.emplace(folder / "screens.csv", scenario, profile.loaded.geo);
  }

  talus::Sinks sinks() {
    talus::Sinks sinks;
    sinks.path_spacing = kPathSpacing;
    sinks.stops = [this](std::span<const talus::StopRow> rows) {
      writer_.write(rows);
      runout_.add(rows);
    };
    sinks.walked = [this](const talus::Release& release, const talus::Path& path) {
      bins_.add(path, release.body.mass);
    };
    sinks.paths = [this](const talus::RecordedPath& path) {
      writer_.write(path);
      if (seen_++ % every_ == 0 && drawn_.size() < kDrawn) drawn_.push_back(path);
    };
    if (crossings_)
      sinks.crossings = [this](std::span<const talus::Crossing> rows) {
        crossings_->write(rows);
        writer_.write(rows);
      };
    return sinks;
  }

  talus::io::ProfileResults finish(const LoadedProfile& profile, const fs::path& folder) {
    const talus::io::ProfileResults results{bins_.bins(), runout_.result()};
    if (crossings_) crossings_->finish();
    writer_.finish(results);
    talus::io::write_text(folder / "profile.svg", talus::io::profile_svg(profile, results, drawn_));
    return results;
  }

 private:
  talus::io::ProfileWriter writer_;
  std::optional<talus::io::CrossingsWriter> crossings_;
  talus::ProfileBins bins_;
  talus::RunoutCounter runout_;
  std::uint64_t every_, seen_ = 0;  // paths are drawn, and were recorded
  std::vector<talus::RecordedPath> drawn_;
};

void summarise(const talus::Totals& totals, const talus::BinDistribution& runout, const std::string& folder) {
  const auto metres = [](double value) { return talus::text_of(std::round(value * 10.0) / 10.0); };
  say("", count_text(totals.released) + " trajectories: " + talus::run::ends_text(totals, "profile"));
  if (runout.count > 0)
    say("", "runout of those that stopped or were trapped: mean " + metres(runout.mean) + " m, P50 " +
                metres(runout.p50) + ", P95 " + metres(runout.p95) + ", P99 " + metres(runout.p99) + ", farthest " +
                metres(runout.max));
  say("", "results are in " + folder);
}

/// Traces, scores and writes everything into `folder`; fills the record.
talus::io::ProfileResults simulate_and_write(const ProfileOptions& options, const LoadedProfile& profile,
                                             const fs::path& folder, Stopwatch& watch, talus::io::RunRecord& record) {
  const talus::Scenario& scenario = profile.loaded.scenario;
  Progress progress(Progress::mode_of(options.quiet, options.progress), scenario.released());
  talus::Tally tally = talus::tally_of(scenario);
  Readers readers(profile, folder);
  talus::Sinks sinks = readers.sinks();
  sinks.progress = [&progress](double share) { return progress.update(share) && !interrupted(); };
  record.totals = talus::simulate(scenario, tally, sinks, record.threads);
  if (record.totals.interrupted || interrupted()) stop_interrupted();
  record.touched_cells = tally.touched_cells();
  const Stopwatch::Lap simulated = watch.lap();
  progress.stage("writing the results");
  talus::io::ProfileResults results = readers.finish(profile, folder);
  talus::io::write_text(folder / "profile.toml", profile.loaded.complete_toml);
  record.files = talus::io::files_in(folder);
  const Stopwatch::Lap written = watch.lap();
  record.cpu.simulate = simulated.cpu - record.totals.sink_cpu_seconds;
  record.cpu.write = written.cpu + record.totals.sink_cpu_seconds;
  record.wall.simulate = simulated.wall;
  record.wall.write = written.wall;
  for (const std::string& warning : profile_warnings(record.totals)) record.warnings.push_back(warning);
  talus::io::write_text(folder / "run.json", talus::io::run_json(record, profile.loaded));
  progress.finish();
  return results;
}

/// Says what the figures rest on, before the blocks are traced.
void say_of_input(const talus::io::LoadedScenario& loaded) {
  if (const auto low_c = talus::io::coefficient_note(loaded)) say("", "note: " + *low_c);
  for (const std::string& warning : loaded.warnings) say("warning", warning);
}

int run_profile(const ProfileOptions& options) {
  Stopwatch watch;
  const LoadedProfile profile = talus::io::load_profile(options.flags);
  catch_signals();
  if (interrupted()) stop_interrupted();
  talus::io::OutputFolder folder(options.out, options.overwrite, talus::io::OutputFolder::Unfinished::Ignore,
                                 "talus profile");
  for (const talus::io::InputFile& input : profile.loaded.inputs)
    if (std::filesystem::path(input.path) != folder.final_path() / "profile.toml") folder.protect(input.path);
  if (!options.quiet) say_of_input(profile.loaded);
  if (const std::string note = folder.later_results_note(); !options.quiet && !note.empty()) say("", note);
  talus::io::RunRecord record;
  record.command = command_line();
  record.warnings = profile.loaded.warnings;
  record.threads = options.threads > 0 ? options.threads : omp_get_num_procs();
  const Stopwatch::Lap read = watch.lap();
  record.cpu.read = read.cpu;
  record.wall.read = read.wall;
  const talus::io::ProfileResults results = simulate_and_write(options, profile, folder.temporary(), watch, record);
  if (interrupted()) stop_interrupted();
  folder.commit();
  if (!options.quiet)
    for (const std::string& warning : profile_warnings(record.totals)) say("warning", warning);
  if (!options.quiet) summarise(record.totals, results.runout.stopped, folder.final_path().string());
  if (!talus::io::too_many_limits(record.totals)) return 0;
  say("error", talus::run::profile_limits_text(record.totals));
  return 1;
}

/// An option that takes places along the profile.
void add_places(CLI::App& command, const char* name, std::vector<double>& places, const char* text) {
  command.add_option(name, places, text)->delimiter(',')->allow_extra_args(false);
}

}  // namespace

void add_profile(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ProfileOptions>();
  CLI::App* command = app.add_subcommand("profile", "Simulate in two dimensions, on a profile");
  talus::io::ProfileFlags& flags = options->flags;
  with(command->add_option("profile", flags.run.scenario, "file of the profile (TOML): docs/profile.md"),
       file_of({"toml"}));
  with(command->add_option("--dem", flags.run.dem, "terrain: a raster in a projected system in metres"),
       file_of({"raster"}));
  with(command->add_option("--line", flags.line, "one line over the terrain, drawn from the top down"),
       file_of({"vector"}));
  add_places(*command, "--source-x", flags.source,
             "where blocks start, in m along the line: one place, or from and to with a comma and no spaces: 20,40");
  with(command->add_option("--diameter", flags.run.diameter, "of all blocks of the profile [m]"),
       number_of(talus::bounds_of("blocks.diameter")));
  with(command->add_option("--release-height", flags.release_height, "above the terrain [m] (1)"),
       number_of(talus::bounds_of("sources.release_height"), "1"));
  with(command->add_option("--preset", flags.run.preset, "parameter set of the ground; talus presets lists them"),
       preset_choice(talus::kDefaultProfilePreset));
  add_places(*command, "--screen-x", flags.screens,
             "where crossings are recorded, in m along the line, with commas and no spaces: 110,199");
  add_surface(*command, flags.run.surface);
  add_effects(*command, flags.run.effects);
  with(command->add_option(
           "--deformation-coefficient", flags.run.deformation_coefficient,
           "c of the impact law (0.25): a lower one gives higher energies and jumps, longer paths and more hits"),
       scalar_of("model.deformation_coefficient"));
  with(command->add_option("-o,--out", options->out, "new folder for the results")->required(), new_folder());
  command->add_flag("--overwrite", options->overwrite, "replace the folder if it holds an earlier result");
  with(command->add_option("--trajectories", flags.run.trajectories, "how many blocks"), scalar_of("trajectories"));
  with(command->add_option("--seed", flags.run.seed, "of the random numbers")->check(seed_number()), scalar_of("seed"));
  add_threads(*command, options->threads);
  add_quiet(*command, options->quiet);
  add_progress(*command, options->progress);
  command->footer(
      "Examples:\n"
      "  talus profile profile.toml -o result\n"
      "  talus profile --dem dem.tif --line line.gpkg --source-x 20 --diameter 1.2 -o result\n\n"
      "An option given here overrides the file. OUT/profile.toml holds all settings.");
  command->callback([&action, options] { action = [options] { return run_profile(*options); }; });
}
