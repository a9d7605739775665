#include "results.hpp"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <optional>

#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/qgis_project.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/io/results/write_crossings.hpp"
#include "talus/io/results/write_lines.hpp"
#include "talus/io/results/write_screens.hpp"
#include "talus/io/results/write_vectors.hpp"
#include "talus/products/gap_exits.hpp"
#include "talus/products/held_at_release.hpp"
#include "talus/products/maps.hpp"
#include "talus/products/screen_summary.hpp"
#include "talus/run/gullies.hpp"
#include "talus/run/summary.hpp"
#include "talus/run/write_maps.hpp"

namespace talus::run {
namespace {

using io::LoadedScenario;

/// Figures of all stops.
struct StopFigures {
  EnergyLines energy_lines;
  std::uint64_t held;  ///< `held_at_release`
  GullyStops gullies;
  GapExits gap_exits;
};

/// Writers of stops, exits, paths and crossings.
class Vectors {
 public:
  Vectors(const LoadedScenario& loaded, const std::filesystem::path& folder, std::function<bool()> proceed)
      : loaded_(loaded),
        scenario_(loaded.scenario),
        folder_(folder),
        proceed_(std::move(proceed)),
        stops_(file_of("stops"), loaded, io::PointsWriter::Layer::Stops),
        exits_(file_of("exits"), loaded, io::PointsWriter::Layer::Exits),
        summary_(scenario_.screens.size()),
        gullies_(scenario_),
        gap_exits_(scenario_.surface.heights()) {
    if (loaded.scenario.output.paths > 0)
      paths_.emplace(file_of("trajectories"), loaded.geo, loaded.scenario.surface.grid());
    if (!loaded.scenario.screens.empty()) crossings_.emplace(folder / "screens.csv", loaded.scenario, loaded.geo);
  }

  Sinks sinks() {
    Sinks sinks;
    sinks.stops = [this](std::span<const StopRow> rows) {
      if (!proceed_()) stop_interrupted();
      stops_.write(rows);
      energy_lines_.add(rows);
      gullies_.add(rows);
      gap_exits_.add(rows);
      held_ += static_cast<std::uint64_t>(std::ranges::count_if(rows, held_at_release));
      exits_.write(rows);
    };
    if (paths_) sinks.paths = [this](const RecordedPath& path) { paths_->write(path); };
    if (crossings_)
      sinks.crossings = [this](std::span<const Crossing> rows) {
        crossings_->write(rows);
        summary_.add(rows);
      };
    return sinks;
  }

  StopFigures figures() const { return {energy_lines_, held_, gullies_, gap_exits_}; }

  void finish(const Totals& totals) {
    stops_.finish();
    exits_.finish();
    if (paths_) paths_->finish();
    if (crossings_) {
      crossings_->finish();
      io::write_text(folder_ / "screens_summary.csv", io::screens_summary_csv(scenario_, summary_));
      io::write_screens(file_of("screens"), loaded_, summary_);
    }
    if (!scenario_.barriers.empty()) io::write_text(folder_ / "barriers.csv", io::barriers_csv(scenario_, totals));
  }

 private:
  std::filesystem::path file_of(const std::string& layer) const {
    return folder_ / (layer + "." + std::string(name_of(scenario_.output.vectors)));
  }

  const LoadedScenario& loaded_;
  const Scenario& scenario_;
  std::filesystem::path folder_;
  std::function<bool()> proceed_;
  io::PointsWriter stops_, exits_;
  std::optional<io::TrajectoriesWriter> paths_;
  std::optional<io::CrossingsWriter> crossings_;
  ScreenSummary summary_;
  GullyStops gullies_;
  GapExits gap_exits_;
  EnergyLines energy_lines_;
  std::uint64_t held_ = 0;
};

/// Writes the rows of the checkpoints: round by round, in each round the parts in their order.
StopFigures write_vectors(const ResultSource& source, const Totals& totals, std::function<bool()> proceed) {
  Vectors vectors(source.loaded, source.folder, std::move(proceed));
  const Sinks sinks = vectors.sinks();
  for (std::uint32_t round = 0; round < source.checkpoints.front().rounds(); ++round)
    for (const Checkpoint& checkpoint : source.checkpoints) checkpoint.replay(round, sinks);
  vectors.finish(totals);
  return vectors.figures();
}

/// "energy line from release to stop, of 812 blocks that stopped farther away than 100 m: median 33.5 deg, 5 %
/// below 31.4 deg, least 28.9 deg".
std::string energy_line_text(const EnergyLines& lines) {
  return "energy line from release to stop, " + io::energy_lines_of(lines.count(), lines.farther_than()) + ": median " +
         with_decimals(lines.percentile(0.5), 1) + " deg, 5 % below " + with_decimals(lines.percentile(0.05), 1) +
         " deg, least " + with_decimals(lines.least(), 1) + " deg";
}

/// "3 rounds: the largest relative 95 % half-width of the 812 cells with a probability above 0.01 is 0.117".
std::string rounds_text(const io::RoundsRecord& rounds) {
  return std::to_string(rounds.done) + (rounds.done == 1 ? " round" : " rounds") +
         ": the largest relative 95 % half-width of the " + std::to_string(rounds.reached.cells) +
         " cells with a probability above " + with_digits(rounds.asked.above, 6) + " is " +
         with_digits(rounds.reached.half_width, 3);
}

/// A warning if `--until-error` was not reached.
std::vector<std::string> warnings_of(const io::RoundsRecord& rounds) {
  if (rounds.done == 0 || !rounds.asked.until_error || rounds.reached_it()) return {};
  if (rounds.reached.cells == 0)
    return {"no cell has a probability above --above, so that --until-error asks nothing; give a smaller --above"};
  return {"--until-error was not reached with " + std::to_string(rounds.done) + " rounds; give a larger --most-rounds"};
}

/// Writes the vectors beside the maps. What fails first ends both.
StopFigures write_maps_and_vectors(const ResultSource& source, const Observer& observer, const io::RunRecord& record) {
  std::atomic<bool> vectors_failed = false, maps_failed = false;
  const auto vectors = [&] {
    try {
      return write_vectors(source, record.totals, [&] { return !maps_failed && !observer.interrupted(); });
    } catch (...) {
      vectors_failed = true;
      throw;
    }
  };
  auto writing = std::async(record.threads > 1 ? std::launch::async : std::launch::deferred, vectors);
  if (record.threads <= 1) writing.wait();  // first, as they fail sooner
  const Grid& grid = source.loaded.scenario.surface.grid();
  try {
    write_maps(make_maps(source.loaded.scenario, source.tally),
               {source.folder, source.loaded.geo, grid.columns, grid.rows,
                [&] { return !vectors_failed && !observer.interrupted(); }},
               record.threads);
  } catch (...) {
    const bool ended_by_vectors = vectors_failed;
    maps_failed = true;
    if (ended_by_vectors) writing.get();  // throws the cause
    throw;
  }
  return writing.get();
}

}  // namespace

void say_later_results(const io::OutputFolder& folder, Observer& observer) {
  if (const std::string note = folder.later_results_note(); !note.empty()) observer.message(note);
}

void write_results(const ResultSource& source, Observer& observer, Stopwatch& watch, io::RunRecord& record) {
  malloc_trim(0);  // frees the memory of the workers' batches before the maps need it
  const LoadedScenario& loaded = source.loaded;
  const std::filesystem::path& folder = source.folder;
  record.folder = std::filesystem::absolute(source.final_folder).lexically_normal().string();
  record.touched_cells = source.tally.touched_cells();
  observer.stage("writing the results");
  StopFigures stops = write_maps_and_vectors(source, observer, record);
  if (source.tally.weights() != nullptr)
    io::write_hazard(folder / io::kHazardFile, loaded, source.tally, record.totals.left_weight);
  record.energy_lines = std::move(stops.energy_lines);
  record.gullies = gully_record(stops.gullies, source.tally, loaded);
  record.left_into_gaps = stops.gap_exits.blocks();
  io::write_styles_beside(folder);
  io::write_text(folder / "scenario.toml", loaded.complete_toml);
  io::write_text(folder / io::kProjectFile,
                 io::project_of(io::files_in(folder), folder, source.final_folder, io::ground_of(loaded)));
  record.files = io::files_in(folder);
  const Stopwatch::Lap written = watch.lap();
  record.cpu.write = written.cpu + record.totals.sink_cpu_seconds;
  record.wall.write = written.wall;
  for (const std::string& warning : warnings_of(record.totals, *record.left_into_gaps))
    record.warnings.push_back(warning);
  for (const std::string& warning : gully_warnings(*record.gullies, record.totals.released))
    record.warnings.push_back(warning);
  for (const std::string& warning : held_warnings(stops.held, record.totals.released, loaded.scenario.effects))
    record.warnings.push_back(warning);
  for (const std::string& warning : warnings_of(record.rounds)) record.warnings.push_back(warning);
  io::write_text(folder / "run.json", io::run_json(record, loaded));
  observer.finish();
}

void summarise(const io::RunRecord& record, const LoadedScenario& loaded, std::size_t told,
               const std::filesystem::path& folder, Observer& observer) {
  for (std::size_t i = told; i < record.warnings.size(); ++i) observer.warning(record.warnings[i]);
  observer.message(count_text(record.totals.released) + " trajectories from " +
                   count_text(loaded.scenario.sources.size()) + " source cells: " + ends_text(record.totals));
  for (std::size_t i = 0; i < record.totals.barriers.size(); ++i)
    observer.message(
        barrier_text(loaded.scenario.barriers.list()[i].id, record.totals.barriers.sum(i), record.totals.pieces > 0));
  if (record.energy_lines.count() > 0) observer.message(energy_line_text(record.energy_lines));
  const std::string seconds = "read " + with_decimals(record.wall.read, 1) + " s, simulated " +
                              with_decimals(record.wall.simulate, 1) + " s, wrote " +
                              with_decimals(record.wall.write, 1) + " s";
  observer.message(count_text(record.touched_cells) + " cells reached; " + seconds);
  if (record.rounds.done > 0) observer.message(rounds_text(record.rounds));
  observer.message("results are in " + folder.string());
}

Outcome judge_limits(const Totals& totals, const std::filesystem::path& folder, Observer& observer) {
  if (!io::too_many_limits(totals)) return Outcome::Done;
  observer.error(
      limits_text(totals) + "; look at the first" +
      (totals.limited_blocks > totals.ended(End::Limit) ? " (talus trace shows the largest piece only)" : "") +
      ": talus trace " + shell_word((folder / "scenario.toml").string()) + " --source " +
      std::to_string(totals.first_limit[0]) + " --block " + std::to_string(totals.first_limit[1]));
  return Outcome::TooManyLimits;
}

}  // namespace talus::run
