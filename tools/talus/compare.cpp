#include <omp.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "progress.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/reports/comparison_report.hpp"
#include "talus/io/results/qgis_project.hpp"
#include "talus/run/write_maps.hpp"

namespace fs = std::filesystem;

namespace {

struct CompareOptions {
  std::string first, second, out;
  std::vector<std::string> more, rasters;
  std::string progress;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

/// Whether a path, which need not be there, is a folder below another one.
bool is_below(const fs::path& path, const fs::path& folder) {
  const fs::path away = fs::weakly_canonical(path).lexically_relative(fs::weakly_canonical(folder));
  return !away.empty() && away != "." && *away.begin() != "..";
}

int compare(const CompareOptions& options) {
  talus::io::ComparisonRecord record;
  record.command = command_line();
  std::vector<std::string> folders{options.first, options.second};
  folders.insert(folders.end(), options.more.begin(), options.more.end());
  const talus::io::ComparedRuns runs(folders, options.rasters);
  for (const std::string& run : folders)
    if (is_below(options.out, run))
      throw talus::InputError(options.out + ": lies in " + run +
                              ", results of talus run, which --overwrite could then "
                              "not replace; give a folder beside it");
  catch_signals();
  talus::io::OutputFolder folder(options.out, options.overwrite, talus::io::OutputFolder::Unfinished::Ignore,
                                 "talus compare");
  for (const std::string& run : folders) {
    folder.protect(fs::path(run) / "run.json");
    record.folders.push_back(fs::absolute(run).lexically_normal().string());
  }
  const fs::path& to = folder.temporary();
  const talus::io::ProjectGround& ground = runs.ground();
  Progress progress(Progress::mode_of(options.quiet, options.progress), 0, "compare");
  const auto proceed = [] { return !interrupted(); };
  const std::vector<talus::io::ComparedFigure> figures =
      runs.figures([&](double share) { return progress.update(share) && proceed(); });
  if (interrupted()) stop_interrupted();
  progress.stage("writing the maps");
  talus::run::write_maps(runs.maps(), {to, ground.geo, ground.columns, ground.rows, proceed},
                         options.threads > 0 ? options.threads : omp_get_num_procs());
  progress.finish();
  const std::string text = talus::io::comparison_markdown(figures, runs.notes());
  talus::io::write_text(to / "compare.md", text);
  talus::io::write_text(to / "compare.csv", talus::io::comparison_csv(figures));
  talus::io::write_text(to / talus::io::kProjectFile,
                        talus::io::project_of(talus::io::files_in(to), to, folder.final_path(), ground));
  record.notes = runs.notes();
  record.files = talus::io::files_in(to);
  talus::io::write_text(to / "compare.json", talus::io::comparison_json(record));
  folder.commit();
  if (options.quiet) return 0;
  print_text(text);
  say("", "the comparison is in " + folder.final_path().string());
  return 0;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "Runs side by side: the worse value of each cell, the change, what differs");
  with(command->add_option("first", options->first, "OUT of talus run: run A")->required(), folder_of_results());
  with(command->add_option("second", options->second, "OUT of another run over the same DEM: run B")->required(),
       folder_of_results());
  with(command->add_option("more", options->more, "further runs: C, D, ..."), folder_of_results());
  with(command->add_option("-o,--out", options->out, "new folder for the comparison")->required(), new_folder());
  command
      ->add_option("--rasters", options->rasters,
                   "names without ending, such as energy,return_period_300; else, of those that all runs have, " +
                       talus::joined(talus::io::rasters_by_default()))
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--overwrite", options->overwrite, "replace the folder if it holds an earlier comparison");
  add_threads(*command, options->threads);
  add_progress(*command, options->progress);
  add_quiet(*command, options->quiet);
  command->footer(
      "Examples:\n  talus compare bare forest -o compared\n"
      "  talus compare job job_c -o compared --rasters hazard_class\n\n"
      "Writes highest_<raster>.tif (of a return period lowest_), of two runs also change_<raster>.tif (B minus A), "
      "compare.csv and compare.md.\n"
      "docs/compare.md says what they mean.");
  command->callback([&action, options] { action = [options] { return compare(*options); }; });
}
