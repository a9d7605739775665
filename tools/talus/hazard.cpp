#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "progress.hpp"
#include "project.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/files/staged_files.hpp"
#include "talus/io/gdal/layer_name.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/hazard_record.hpp"
#include "talus/io/results/objects_file.hpp"
#include "talus/io/results/qgis_project.hpp"
#include "talus/io/results/recorded_plan.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/products/hazard_maps.hpp"
#include "talus/run/write_maps.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/simulate.hpp"
#include "talus/simulate/tally_of.hpp"

namespace fs = std::filesystem;

namespace {

/// Bounds of --width.
constexpr talus::Bounds kWidth{"width", "m", "of the object", 0.0, 1000.0, talus::Bounds::AboveMin};

struct HazardOptions {
  std::string folder, matrix, objects, frequency, width_field, name_field;
  double width = 0.0;  // of the object [m]; 0: the cell
  int threads = 0;
  std::string progress;
  bool curves = false, overwrite = false, quiet = false;
  Progress::Mode mode() const { return Progress::mode_of(quiet, progress); }
};

/// The hazard file, which a run writes if its sources have frequencies.
fs::path tally_file(const fs::path& folder) {
  talus::io::require_results(folder);
  if (const auto file = talus::io::hazard_file_of(folder)) return *file;
  if (talus::io::read_run(folder.string()).of_profile)
    throw talus::InputError(folder.string() + ": is of a profile, which has no maps: hazard needs a run over a DEM");
  throw talus::InputError(
      folder.string() +
      ": this run has no annual frequencies; give the sources a field frequency (events per year; of another name: "
      "--field frequency=NAME), or the run --frequency (events per year of all sources together), or its scenario "
      "[frequency] total, per_area or power_law, and run again");
}

/// What an object of some width needs: class limits that are thresholds of the run.
void check_width(const talus::io::HazardHeader& header, const talus::HazardMatrix& matrix) {
  for (const double energy : matrix.energies)
    if (std::ranges::count(header.rules.bins.thresholds(), energy) == 0)
      throw talus::InputError("--width: the matrix has a class limit of " + talus::text_of(energy) +
                              " kJ, must be one of the run's energy thresholds; run again with it in "
                              "--thresholds ([output] energy_thresholds), or leave out --width");
}

/// Reads the hazard file of the run and evaluates every cell.
std::unique_ptr<talus::HazardSurvey> survey_of(const fs::path& file, int threads, Progress& progress,
                                               talus::io::HazardRecord& record) {
  std::unique_ptr<talus::HazardSurvey> survey;
  record.header = talus::io::read_hazard(
      file,
      [&](const talus::io::HazardHeader& h) {
        talus::io::require_plan_of_tally(file.parent_path(), h.plan);
        if (record.width > 0.0) check_width(h, record.matrix);
        survey = std::make_unique<talus::HazardSurvey>(
            h.grid, h.rules, record.matrix, talus::ObjectWidth{record.width, h.passages_below}, record.curves);
      },
      [&](const talus::io::HazardRow& row) {
        if (interrupted()) stop_interrupted();
        survey->set_row(row.row, row.terrain, row.touched, threads);
        const int rows = survey->grid().rows;
        progress.update(static_cast<double>(rows - row.row) / rows);
      });
  survey->finish(threads);
  return survey;
}

/// A warning if the map is too small for the hazard.
std::vector<std::string> warnings_of(const talus::io::HazardHeader& header) {
  const double left = talus::io::left_per_year(header), all = header.rules.scale.total;
  if (!(left > talus::io::kWarnedLeftShare * all)) return {};
  return {talus::with_digits(left, 3) + " of the " + talus::with_digits(all, 3) + " events per year (" +
          talus::percent(left / all) +
          ") leave the DEM or meet missing data: beyond the cells marked in band `cut short` of hazard_class.tif the "
          "hazard goes on, and the map does not show it; run again with a larger DEM, or with "
          "the holes inside it filled (left_into_gaps in run.json counts the blocks that leave into them)"};
}

/// Whether the limits and classes are those by default, whatever their names.
bool is_swiss(const talus::HazardMatrix& matrix) {
  const talus::HazardMatrix swiss;
  return matrix.energies == swiss.energies && matrix.years == swiss.years && matrix.classes == swiss.classes;
}

std::vector<std::string> warnings_of(const talus::HazardMatrix& matrix, const talus::HazardRules& rules) {
  std::vector<std::string> warnings;
  for (const double energy : matrix.energies)
    if (std::ranges::count(rules.bins.thresholds(), energy) == 0)
      warnings.push_back("the matrix has a class limit of " + talus::text_of(energy) +
                         " kJ, which is none of the run's energy_thresholds: its frequency is interpolated within a "
                         "bin of 12.5 %, with wider bounds");
  return warnings;
}

/// A warning if the objects count passages that the maps leave out; empty if not.
std::string warning_of_objects(const HazardOptions& options, const talus::io::HazardHeader& header) {
  if (options.objects.empty() || !(header.passages_below > 0.0)) return {};
  return "--objects counts passages at any height: [output] passages_below = " + talus::text_of(header.passages_below) +
         " m holds for passage densities and the maps of --width only";
}

/// The recorded plan, with the weighting that is asked for, which goes into the record.
talus::io::LoadedScenario recorded_plan(const HazardOptions& options, talus::io::HazardRecord& record) {
  talus::io::LoadedScenario loaded = talus::io::recorded_plan(options.folder, record.header.plan);
  if (!options.frequency.empty()) record.frequency = talus::io::apply_weighting(options.frequency, loaded.scenario);
  return loaded;
}

/// Traces the recorded plan again with other weights and evaluates every cell.
std::unique_ptr<talus::HazardSurvey> reweighted_survey(const HazardOptions& options, const talus::Scenario& scenario,
                                                       Progress& progress, talus::io::HazardRecord& record) {
  if (record.width > 0.0) check_width(record.header, record.matrix);
  if (!options.quiet)
    say("", "repeats the run with another weighting: " + count_text(scenario.released()) +
                " trajectories of the recorded plan, with the same bits");
  if (const std::string shares = talus::io::class_shares_text(record.frequency); !shares.empty() && !options.quiet)
    say("", shares);
  talus::Tally tally = talus::tally_of(scenario);
  if (tally.weights() == nullptr) throw std::logic_error("a plan with frequencies has no weights");
  talus::Sinks sinks;
  sinks.progress = [&progress](double share) { return progress.update(share) && !interrupted(); };
  const talus::Totals totals = talus::simulate(scenario, tally, sinks, options.threads);
  if (totals.interrupted || interrupted()) stop_interrupted();
  record.header.rules = tally.hazard_rules();
  record.header.left_weight = totals.left_weight;
  auto survey = std::make_unique<talus::HazardSurvey>(record.header.grid, record.header.rules, record.matrix,
                                                      talus::ObjectWidth{record.width, record.header.passages_below},
                                                      record.curves);
  const talus::Grid& grid = scenario.surface.grid();
  for (int row = 0; row < grid.rows; ++row) {
    std::vector<bool> terrain;
    std::vector<talus::HazardAt> touched;
    for (int column = 0; column < grid.columns; ++column) {
      terrain.push_back(!std::isnan(scenario.surface.heights().at(column, row)));
      if (const talus::HazardCell* cell = tally.hazard(column, row))
        touched.push_back({column, *cell, tally.find(column, row)->exits > 0});
    }
    survey->set_row(row, std::move(terrain), touched, options.threads);
  }
  survey->finish(options.threads);
  return survey;
}

/// Runs the recorded plan again and writes the hazard of each object. Returns how often each is hit, in words.
std::vector<std::string> write_objects(const HazardOptions& options, const talus::io::LoadedScenario& loaded,
                                       const talus::io::ObjectLayer& layer, const fs::path& folder,
                                       talus::io::HazardRecord& record) {
  for (const std::string& warning : layer.warnings()) record.warnings.push_back(warning);
  if (const std::string text = layer.not_copied_text(record.header.rules, record.matrix); !text.empty())
    record.warnings.push_back(text);
  for (const std::string& text : {layer.lines_text(), layer.names_text()})
    if (!options.quiet && !text.empty()) say("", options.objects + ": " + text);
  if (!options.quiet)
    say("", "repeats the run for the objects: " + count_text(loaded.scenario.released()) +
                " trajectories of the recorded plan, with the same bits");
  const auto weights = talus::AnnualWeights::of(loaded.scenario);
  if (!weights) throw std::logic_error("a plan with frequencies has no weights");
  Progress progress(options.mode(), loaded.scenario.released());
  const std::vector<talus::ObjectHits> hits = talus::replay_objects(
      loaded.scenario, *weights, layer.objects(),
      [&progress](double share) { return progress.update(share) && !interrupted(); }, options.threads);
  if (interrupted() || hits.empty()) stop_interrupted();
  talus::HazardRules rules = record.header.rules;
  rules.scale = weights->scale();  // a run in rounds has recorded another
  layer.write(folder, loaded, rules, hits, record.matrix);
  progress.finish();
  record.objects_file = options.objects;
  std::vector<std::string> lines = layer.hits_text(rules, hits);
  lines.emplace_back(
      "energies of objects are the largest within the outline, those of the maps when a block passes: for a wall take "
      "entry_<kJ> of objects.csv");
  if (const auto note = talus::io::pieces_note(options.folder)) lines.insert(lines.begin(), *note);
  return lines;
}

/// Says whose hazard the maps show.
std::string object_text(const talus::io::HazardRecord& record) {
  if (record.width > 0.0)
    return "hazard of an object " + talus::text_of(record.width) + " m wide (and the diameter of the block)";
  const talus::Grid& grid = record.header.grid;
  return "hazard of a cell, " + talus::with_digits(grid.cell_x, 4) + " x " + talus::with_digits(grid.cell_y, 4) +
         " m (larger cells are hit more often; --width 10 for an object 10 m wide, whatever the cell)";
}

/// The record of what the command line asks for, still without results. Throws InputError for files that are not there.
talus::io::HazardRecord asked_of(const HazardOptions& options) {
  talus::io::HazardRecord record;
  record.command = command_line();
  record.matrix_file = options.matrix;
  record.width = options.width;
  record.curves = options.curves;
  for (const std::string& input : {talus::io::file_of_layer(options.objects), options.frequency})
    if (!input.empty() && !input.starts_with("/vsi") && input.find(':') == std::string::npos && !fs::exists(input))
      throw talus::InputError(input + ": there is no such file" +
                              (input == options.frequency ? "; --frequency of this command takes a file: "
                                                            "docs/hazard.md, \"Another weighting\""
                                                          : talus::io::spelling_of_layer(input)));
  if (!options.matrix.empty()) record.matrix = talus::io::read_matrix(options.matrix);
  return record;
}

talus::io::ObjectFields object_fields(const HazardOptions& options) {
  talus::io::ObjectFields fields;
  fields.line_width = options.width;
  fields.width = options.width_field;
  fields.name = options.name_field;
  return fields;
}

/// Files of an earlier command that this one has not made, but for the style of marks that no cell has now.
std::vector<std::string> removed_by(const talus::io::StagedFiles& staged) {
  std::vector<std::string> names = staged.to_remove();
  std::erase_if(names, [](const std::string& name) {
    return std::ranges::count(talus::io::project_layers(), name, &talus::io::ProjectLayer::style) > 0;
  });
  return names;
}

/// Files and frequencies of an earlier talus hazard in the folder that this command does not make again.
struct NotAskedFor {
  std::vector<std::string> files;
  std::string frequency;  // the file of its frequencies

  void tell() const {
    if (!files.empty())
      say(std::ranges::count(files, "objects.csv") > 0 ? "warning" : "",
          "removed, as not asked for this time: " + talus::joined(files) + kEarlier);
    if (!frequency.empty())
      say("warning", "frequencies are those of the run, no longer those of " + frequency + kEarlier +
                         ": to keep them give --frequency");
  }

 private:
  static constexpr const char* kEarlier = " (of the earlier talus hazard in this folder)";
};

NotAskedFor not_asked_for(const HazardOptions& options, const talus::io::StagedFiles& staged) {
  return {removed_by(staged), options.frequency.empty() ? talus::io::frequency_file_of(options.folder) : ""};
}

int hazard(const HazardOptions& options) {
  catch_signals();
  const fs::path folder(options.folder), file = tally_file(folder);
  talus::io::HazardRecord record = asked_of(options);
  talus::io::StagedFiles staged(folder, "hazard.json", options.overwrite);
  std::optional<talus::io::LoadedScenario> plan;  // where its trajectories are traced again
  std::optional<talus::io::ObjectLayer> layer;    // its faults are found before the maps are made
  if (!options.frequency.empty() || !options.objects.empty()) {
    record.header = talus::io::read_hazard_header(file);
    talus::io::require_plan_of_tally(folder, record.header.plan);
    plan = recorded_plan(options, record);
  }
  if (!options.objects.empty()) layer.emplace(options.objects, *plan, object_fields(options));
  Progress progress(options.mode(), 0, options.frequency.empty() ? "evaluate" : "simulate");
  const auto survey = options.frequency.empty() ? survey_of(file, options.threads, progress, record)
                                                : reweighted_survey(options, plan->scenario, progress, record);
  record.cells = survey->cells();
  if (record.width == 0.0) record.warnings = warnings_of(record.matrix, record.header.rules);
  if (record.width > talus::io::kWidestObject)
    record.warnings.push_back("--width " + talus::text_of(record.width) +
                              ": an object as wide is hit by what passes anywhere near; the width of a house or road "
                              "in metres is meant");
  for (const std::string& warning : warnings_of(record.header)) record.warnings.push_back(warning);
  if (const std::string warning = warning_of_objects(options, record.header); !warning.empty())
    record.warnings.push_back(warning);
  if (is_swiss(record.matrix) && !record.header.rules.with_rotation)
    record.warnings.emplace_back(
        "the Swiss classes count the energy with rotation, this run the translational one: classes may be too low "
        "(unsafe); run again with --count-rotation");
  for (std::string& note : talus::io::notes_of_run(folder, {record.frequency, true, false}))
    record.warnings.push_back(std::move(note));
  if (record.width > 0.0 && talus::io::pieces_note(folder)) record.warnings.emplace_back(talus::io::kBoundsOfPieces);

  progress.stage("writing the maps");
  const talus::Grid& grid = survey->grid();
  talus::run::write_maps(
      talus::make_hazard_maps(*survey),
      {staged.temporary(), record.header.geo, grid.columns, grid.rows, [] { return !interrupted(); }},
      options.threads > 0 ? options.threads : omp_get_num_procs());
  progress.finish();
  std::vector<std::string> objects;
  if (layer) objects = write_objects(options, *plan, *layer, staged.temporary(), record);
  record.files = staged.files();
  talus::io::write_text(staged.temporary() / "hazard.json", talus::io::hazard_json(record));
  const NotAskedFor not_asked = not_asked_for(options, staged);
  staged.commit();
  refresh_project(folder);
  if (options.quiet) return 0;
  not_asked.tell();
  for (const std::string& warning : record.warnings) say("warning", warning);
  say_old_report(folder);
  for (const std::string& object : objects) say("", object);
  if (record.header.rules.with_rotation)
    say("", "energies count the rotation, as the run says (count_rotation): thresholds, intensities, classes, objects");
  say("", object_text(record) + ": " + count_text(record.cells) + " cells that something passes, " +
              talus::with_digits(record.header.rules.scale.total, 4) + " events per year; results are in " +
              fs::absolute(folder).lexically_normal().string());
  return 0;
}

}  // namespace

void add_hazard(CLI::App& app, Action& action) {
  const auto options = std::make_shared<HazardOptions>();
  CLI::App* command =
      app.add_subcommand("hazard", "Annual frequencies, return periods and classes of hazard from a run");
  with(command->add_option("folder", options->folder, "OUT of a run whose sources have frequencies")->required(),
       folder_of_results());
  with(command->add_option("--matrix", options->matrix,
                           "classes by intensity and return period (TOML); else 30, 300 kJ and 30, 100, 300 years"),
       file_of({"toml"}));
  with(command->add_option(
           "--objects", options->objects,
           "polygons or lines (as wide as their field width, else --width, else 0 m): how often each is hit, "
           "with which energy, and from where; repeats the run"),
       file_of({"vector"}));
  CLI::Option* const objects = command->get_option("--objects");
  command
      ->add_option("--width-field", options->width_field, "the field of --objects with the width of a line [m]; width")
      ->needs(objects);
  command
      ->add_option("--name-field", options->name_field, "the field of --objects with their names; name, id or object")
      ->needs(objects);
  with(command->add_option("--frequency", options->frequency,
                           "another weighting (TOML: [frequency], [features]); repeats the run"),
       file_of({"toml"}));
  CLI::Option* width = command->add_option(
      "--width", options->width,
      "m: the maps are for an object of this width (and the diameter of the block) at each place, else for the "
      "cell; with --objects also the width of lines without a field width");
  with(width, number_of(kWidth))->check([](const std::string& text) -> std::string {
    const std::optional<double> value = talus::decimal_number(text);
    if (value && !talus::fault_of(kWidth, *value)) return {};
    return text + ": must be above 0 and at most 1000 m (width of the object; leave it out for the cell)";
  });
  command->add_flag("--curves", options->curves,
                    "hazard_curves.tif: how often each energy is exceeded, a band per energy (0, 1, 2, 4, ... kJ and "
                    "the thresholds; with --width: 0 and the thresholds)");
  command->add_flag("--overwrite", options->overwrite, "replace the hazard maps that are there");
  add_threads(*command, options->threads);
  add_progress(*command, options->progress);
  add_quiet(*command, options->quiet);
  command->footer(
      "Examples:\n  talus hazard result\n  talus hazard result --width 10 --curves --objects houses.gpkg\n\n"
      "A later hazard --overwrite replaces the earlier one as a whole: ask for all at once.\n"
      "Writes into the folder: annual_frequency.tif, return_period_<kJ>.tif, intensity_T<years>.tif,\n"
      "hazard_class.tif, hazard.json; with --curves hazard_curves.tif. Nothing is simulated again, but for "
      "--frequency and --objects, which adds objects.gpkg, objects.csv,\n"
      "objects_curves.csv and objects_sources.csv.");
  command->callback([&action, options] { action = [options] { return hazard(*options); }; });
}
