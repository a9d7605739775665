#include "run_results.hpp"

#include <malloc.h>

#include <cstdio>
#include <future>
#include <optional>

#include "commands.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/write_crossings.hpp"
#include "talus/io/results/write_lines.hpp"
#include "talus/io/results/write_vectors.hpp"
#include "talus/products/maps.hpp"
#include "talus/products/screen_summary.hpp"
#include "write_maps.hpp"

namespace {

using talus::io::LoadedScenario;

/// The files of rows: stops, paths, crossings.
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
    sinks.stops = [this](std::span<const talus::StopRow> rows) {
      if (interrupted()) stop_interrupted();
      stops_.write(rows);
    };
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

/// Writes the rows that the checkpoints keep, round by round and in each the parts in their order.
void write_vectors(const LoadedScenario& loaded, std::span<const talus::io::Checkpoint> checkpoints, const talus::Totals& totals,
                   const std::filesystem::path& folder) {
  Vectors vectors(loaded, folder);
  const talus::Sinks sinks = vectors.sinks();
  for (std::uint32_t round = 0; round < checkpoints.front().rounds(); ++round)
    for (const talus::io::Checkpoint& checkpoint : checkpoints) checkpoint.replay(round, sinks);
  vectors.finish(totals);
}

/// "3 rounds: the largest relative half-width of 812 cells with a probability above 0.01 is 0.117".
std::string rounds_text(const talus::io::RoundsRecord& rounds) {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "%u round%s: the largest relative 95 %% half-width of the %llu cells with a probability above %g is %.3g",
      rounds.done, rounds.done == 1 ? "" : "s", static_cast<unsigned long long>(rounds.reached.cells),
      rounds.asked.above, rounds.reached.half_width);
  return text;
}

/// What `--until-error` did not reach.
std::vector<std::string> warnings_of(const talus::io::RoundsRecord& rounds) {
  if (rounds.done == 0 || !rounds.asked.until_error || rounds.reached_it()) return {};
  if (rounds.reached.cells == 0)
    return {"no cell has a probability above --above, so that --until-error asks nothing; give a smaller --above"};
  return {"--until-error was not reached with " + std::to_string(rounds.done) + " rounds; give a larger --most-rounds"};
}

}  // namespace

std::vector<std::string> warnings_of(const talus::Totals& totals) {
  const std::uint64_t left = count_of(totals, talus::End::Left);
  if (static_cast<double>(left) <= 0.01 * static_cast<double>(totals.released)) return {};
  return {share_text(left, totals.released) + " of the trajectories (" + count_text(left) +
          ") left the DEM or met missing data: the maps do not show how far they go; a larger DEM would"};
}

void summarise(const talus::io::RunRecord& record, const LoadedScenario& loaded, std::size_t told,
               const std::string& folder) {
  for (std::size_t i = told; i < record.warnings.size(); ++i) say("warning", record.warnings[i]);
  const talus::Totals& t = record.totals;
  say("", count_text(t.released) + " trajectories from " + count_text(loaded.scenario.sources.size()) +
              " source cells: " + ends_text(t));
  char seconds[96];
  std::snprintf(seconds, sizeof seconds, "read %.1f s, simulated %.1f s, wrote %.1f s", record.wall.read,
                record.wall.simulate, record.wall.write);
  say("", count_text(record.touched_cells) + " cells reached; " + seconds);
  if (record.rounds.done > 0) say("", rounds_text(record.rounds));
  say("", "results are in " + folder);
}

void write_results(const LoadedScenario& loaded, std::span<const talus::io::Checkpoint> checkpoints, const talus::Tally& tally,
                   const std::filesystem::path& folder, Stopwatch& watch, Progress& progress,
                   talus::io::RunRecord& record) {
  malloc_trim(0);  // gives back what the workers' batches took, before the maps need room
  record.touched_cells = tally.touched_cells();
  progress.stage("writing the results");
  const auto vectors = [&] { write_vectors(loaded, checkpoints, record.totals, folder); };
  const bool aside = record.threads > 1;
  auto writing = std::async(aside ? std::launch::async : std::launch::deferred, vectors);
  const talus::Grid& grid = loaded.scenario.surface.grid();
  write_maps(talus::make_maps(loaded.scenario, tally),
             {folder, loaded.geo, grid.columns, grid.rows, [] { return !interrupted(); }}, record.threads);
  if (tally.weights() != nullptr) talus::io::write_hazard(folder / talus::io::kHazardFile, loaded, tally);
  writing.get();
  talus::io::write_text(folder / "scenario.toml", loaded.complete_toml);
  record.files = files_in(folder);
  const Stopwatch::Lap written = watch.lap();
  record.cpu.write = written.cpu + record.totals.sink_cpu_seconds;
  record.wall.write = written.wall;
  for (const std::string& warning : warnings_of(record.totals)) record.warnings.push_back(warning);
  for (const std::string& warning : warnings_of(record.rounds)) record.warnings.push_back(warning);
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
