#include <memory>

#include "commands.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/run/run_session.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/presets.hpp"
#include "terminal_observer.hpp"

namespace {

struct RunOptions {
  talus::run::RunRequest request;
  std::string progress;
  bool quiet = false;
};

/// The observer of a process. Of several processes only the leader prints.
TerminalObserver observer_of(const RunOptions& options, const talus::ProcessGroup& processes) {
  const bool leads = processes.leads(), quiet = options.quiet || !leads;
  return {Progress::mode_of(quiet, leads ? options.progress : ""), quiet};
}

int run(const RunOptions& options, talus::ProcessGroup& processes) {
  if (processes.size() > 1) catch_signals();  // they end together
  talus::run::RunRequest request = options.request;
  request.command = command_line();
  TerminalObserver observer = observer_of(options, processes);
  return exit_code(talus::run::RunSession(std::move(request), observer, processes).run());
}

/// "30,300".
std::string default_thresholds() {
  std::string text;
  for (const double energy : talus::OutputSettings{}.energy_thresholds)
    text += (text.empty() ? "" : ",") + talus::text_of(energy);
  return text;
}

}  // namespace

void add_scenario_options(CLI::App& command, talus::io::RunFlags& flags) {
  with(command.add_option("scenario", flags.scenario, "scenario file (TOML)"), file_of({"toml"}));
  with(command.add_option("--dem", flags.dem, "terrain: a raster in a projected system in metres"),
       file_of({"raster"}));
  with(command.add_option("--sources", flags.sources, "where blocks start: polygons, lines or points"),
       file_of({"vector"}));
  command.add_option("--sources-layer", flags.sources_layer,
                     "the layer of the sources, of a file with several; or --sources FILE|layername=NAME");
  with(command.add_option("--screens", flags.screens, "lines: what crosses them is recorded"), file_of({"vector"}));
  with(command.add_option("--barriers", flags.barriers,
                          "lines of fences, dams or walls, with the fields height [m] and capacity [kJ]"),
       file_of({"vector"}));
  with(command.add_option("--zones", flags.zones,
                          "ground: polygons, or a raster; what it names is a zone of the scenario, or a preset"),
       file_of({"vector", "raster"}));
  with(command.add_option("--zone-field", flags.zone_field, "the field of --zones that names the zone or preset; zone"),
       default_of("zone"));
  command
      .add_option("--field", flags.fields,
                  "NAME=COLUMN: a field of the sources under another name, as release_height=HEIGHT; NAME= alone: that "
                  "field is not read; may be repeated")
      ->allow_extra_args(false);
  add_effects(command, flags.effects);
  with(command.add_option("--preset", flags.preset, "parameter set of the ground; talus presets lists them"),
       preset_choice(talus::kDefaultPreset));
  with(command.add_option("--parameters", flags.parameters,
                          "a ground that talus calibrate or diagnose has fitted (fitted.toml), in place of --preset"),
       file_of({"toml"}));
  add_surface(command, flags.surface);
  with(command.add_option("--diameter", flags.diameter, "of the blocks [m]"),
       number_of(talus::bounds_of("blocks.diameter")));
  with(command.add_option(
           "--deformation-coefficient", flags.deformation_coefficient,
           "c of the impact law (0.25): a lower one gives higher energies and jumps, longer paths and more hits"),
       scalar_of("model.deformation_coefficient"));
  with(command.add_option("--frequency", flags.frequency, "events per year of all sources together, for talus hazard"),
       number_of(talus::bounds_of("frequency.total")));
  with(command
           .add_option("--thresholds", flags.thresholds,
                       "energies of the maps of exceedance [kJ], with commas and no spaces: 30,300 (default)")
           ->delimiter(',')
           ->allow_extra_args(false),
       number_of(talus::bounds_of("output.energy_thresholds"), default_thresholds()));
  with(command.add_option("--trajectories", flags.trajectories, "per source cell"), scalar_of("trajectories"));
  with(command.add_option("--seed", flags.seed, "of the random numbers")->check(seed_number()), scalar_of("seed"));
  command.add_flag("--energy-total", flags.energy_total, "also energy_total.tif: the energy with rotation");
  command.add_flag("--count-rotation", flags.count_rotation,
                   "thresholds, frequencies, classes and objects count the energy with rotation, not the translational "
                   "one; also energy_total.tif");
  command.add_flag("--bounds", flags.bounds, "also 95 % bounds of the percentiles: energy_bounds.tif and others");
  with(command.add_option("--vectors", flags.vectors,
                          "gpkg or fgb (gpkg): GeoPackage or FlatGeobuf for stops, exits, paths and screens"),
       vectors_choice());
}

void add_run(CLI::App& app, Action& action, talus::ProcessGroup& processes) {
  const auto options = std::make_shared<RunOptions>();
  talus::run::RunRequest& request = options->request;
  CLI::App* command = app.add_subcommand("run", "Simulate a scenario and write its hazard maps");
  add_scenario_options(*command, request.flags);
  with(command->add_option("-o,--out", request.out, "new folder for the results")->required(), new_folder());
  command->add_flag("--overwrite", request.overwrite, "replace the folder if it holds an earlier result");
  command
      ->add_option("--threads", request.threads,
                   "all processors where it is not given, of several processes one each; the results are the same")
      ->check(startable_threads());
  with(command
           ->add_option("--lanes", request.lanes,
                        "trajectories in one instruction; as many as the processor has where it is not given; the "
                        "results are the same")
           ->check(lanes_of_machine()),
       lane_choice());
  command->add_option("--part", request.part, "I/N: only part I of N of the source cells, for talus merge");
  command->add_flag("--resume", request.resume, "go on with an interrupted run of the same command");
  command->add_option("--memory", request.memory, "such as 2G: what does not fit lies in a file beside the results");
  with(command->add_option("--checkpoint", request.checkpoint, "seconds between two saves of the work to disk")
           ->check(between(0.0, 1e6)),
       with_unit("s", request.checkpoint));
  with(command
           ->add_option("--rounds", request.rounds.count, "number of times that the scenario's trajectories are traced")
           ->check(CLI::Range(1, static_cast<int>(talus::kMostRounds))),
       default_of(request.rounds.count));
  CLI::Option* until =
      command->add_option("--until-error", request.rounds.until_error,
                          "rounds until the relative 95 % half-width of the impact probability is below this");
  until->check(between(1e-4, 10.0))->excludes("--rounds");
  CLI::Option* above = with(
      command
          ->add_option("--above", request.rounds.above, "the error counts in all cells with a larger probability; 0.01")
          ->check(between(1e-9, 1.0)),
      default_of(request.rounds.above));
  with(command->add_option("--most-rounds", request.rounds.most, "largest number of rounds with --until-error (100)")
           ->check(CLI::Range(1, static_cast<int>(talus::kMostRounds)))
           ->needs(until),
       default_of(request.rounds.most));
  add_quiet(*command, options->quiet);
  add_progress(*command, options->progress);
  command->footer(
      "Examples:\n"
      "  talus run scenario.toml -o result\n"
      "  talus run --dem dem.tif --sources cliffs.gpkg --diameter 1.2 --trajectories 100 -o result\n\n"
      "An option given here overrides the scenario file. OUT/scenario.toml holds all settings.");
  command->callback([&action, &processes, options, above] {
    if (above->count() > 0 && !options->request.rounds.several())
      throw talus::InputError("--above: must come with --until-error, or --rounds of 2 or more; see talus run --help");
    action = [options, &processes] { return run(*options, processes); };
  });
}
