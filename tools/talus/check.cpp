#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "commands.hpp"
#include "estimate.hpp"
#include "progress.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_file.hpp"
#include "talus/io/gdal/crs.hpp"
#include "talus/io/gdal/pit_points.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/physics/trace.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/products/energy_words.hpp"
#include "talus/products/expected_cells.hpp"
#include "talus/products/gap_exits.hpp"
#include "talus/products/held_at_release.hpp"
#include "talus/run/gullies.hpp"
#include "talus/run/summary.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/scenario/retreat.hpp"
#include "talus/simulate/screens/screens.hpp"
#include "talus/simulate/tally/visits.hpp"
#include "talus/simulate/tally_of.hpp"
#include "talus/terrain/dem_figures.hpp"
#include "talus/terrain/pits.hpp"

namespace {

using talus::Scenario;
using talus::io::LoadedScenario;
using Clock = std::chrono::steady_clock;

constexpr double kSampleSeconds = 1.5;

struct CheckOptions {
  talus::io::RunFlags flags;
  std::string pits;
  unsigned threads = 0;
  bool overwrite = false, quiet = false;
};

/// Sums over a sample of the trajectories.
struct Sample {
  std::uint64_t traced = 0, touched_cells = 0, crossings = 0;
  std::vector<std::uint64_t> cells_by_passages;
  double seconds = 0.0, length = 0.0;  // of one processor; in space [m]
  talus::Totals totals;                // only the ends
  std::uint64_t held = 0;              // `held_at_release`
  std::uint64_t left_into_gaps = 0;
  talus::io::GullyRecord gullies;
};

/// Traces and scores trajectories that are spread evenly over all releases (multiples of the golden ratio, modulo 1).
Sample trace_sample(const LoadedScenario& loaded) {
  const Scenario& scenario = loaded.scenario;
  const talus::World world = scenario.world();
  talus::Tally tally = talus::tally_of(scenario);
  const talus::AnnualWeights* weights = tally.weights();
  talus::VisitBatch batch(scenario.surface.grid(), talus::length_rules(scenario.output));
  if (tally.keeps_energy_total()) batch.keep_energy_total();
  const talus::ScreenFinder screens(scenario);
  std::vector<talus::Crossing> crossings;
  talus::GullyStops gullies(scenario);
  talus::GapExits gap_exits(scenario.surface.heights());
  Sample sample;
  const Clock::time_point start = Clock::now();
  const std::uint64_t all = scenario.released(), most = std::min<std::uint64_t>(all, 20'000);
  std::uint64_t begun = 0;
  const auto next = [&](talus::Release& release, std::uint64_t&) {
    if (begun == most || !(sample.seconds < kSampleSeconds)) return false;
    const double share = std::fmod(0.6180339887498949 * static_cast<double>(begun++), 1.0);
    const auto number = std::min(all - 1, static_cast<std::uint64_t>(share * static_cast<double>(all)));
    release = talus::make_release(scenario, static_cast<std::uint32_t>(number / scenario.trajectories),
                                  static_cast<std::uint32_t>(number % scenario.trajectories));
    return true;
  };
  talus::Tracer(world).run(next, [&](const talus::Release& release, const talus::Path& path, std::uint64_t) {
    if (weights) batch.set_annual_share({weights->weight(scenario, release.source, release.block), sample.traced, 1});
    batch.add(path, release.body, release.source, nullptr);
    crossings.clear();
    screens.find(release, path, crossings);
    bool left = path.end == talus::End::Left, limited = path.end == talus::End::Limit;
    talus::trace_pieces(world, path, [&](const talus::Release& piece, const talus::Path& way) {
      batch.add(way, piece.body, release.source, nullptr, true);
      screens.find(piece, way, crossings);
      left = left || way.end == talus::End::Left;
      limited = limited || way.end == talus::End::Limit;
    });
    sample.totals.left_blocks += left ? 1U : 0U;
    sample.totals.limited_blocks += limited ? 1U : 0U;
    if (batch.full()) tally.add(batch), batch.clear();
    ++sample.traced;
    sample.crossings += crossings.size();
    sample.length += path.length;
    ++sample.totals.ends[static_cast<std::size_t>(path.end)];
    ++sample.totals.released;
    const talus::StopRow stop = talus::stop_row(release, path);
    sample.held += talus::held_at_release(stop) ? 1U : 0U;
    gullies.add({&stop, 1});
    gap_exits.add({&stop, 1});
    sample.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  });
  tally.add(batch);
  sample.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  sample.gullies = talus::run::gully_record(gullies, tally, loaded);
  sample.left_into_gaps = gap_exits.blocks();
  sample.touched_cells = tally.touched_cells();
  sample.cells_by_passages = tally.cells_by_passages(4);
  return sample;
}

void line(const char* what, const std::string& text) {
  print("%-14s%s\n", what, text.c_str());
}

std::string range_text(const talus::Range& range, const char* unit) {
  const std::string low = talus::text_of(range.low);
  return (range.low == range.high ? low : low + " to " + talus::text_of(range.high)) +
         (*unit == '\0' ? "" : std::string(" ") + unit);
}

std::string list_text(const std::vector<double>& values, const char* unit) {
  std::vector<std::string> words;
  for (const double value : values) words.push_back(talus::text_of(value));
  return words.empty() ? "none" : talus::joined(words) + " " + unit;
}

/// @param maps_pits  the pits are written to a file
void print_terrain(const LoadedScenario& loaded, bool maps_pits) {
  const char* const way = maps_pits ? "" : "; --pits maps them";
  const talus::Raster<float>& heights = loaded.scenario.surface.heights();
  const talus::Grid& grid = heights.grid;
  const auto missing =
      static_cast<std::uint64_t>(std::ranges::count_if(heights.values, [](float z) { return std::isnan(z); }));
  const talus::io::GeoReference& geo = loaded.geo;
  line("terrain", count_text(static_cast<std::uint64_t>(grid.columns)) + " x " +
                      count_text(static_cast<std::uint64_t>(grid.rows)) + " cells of " +
                      talus::with_digits(geo.cell_x, 4) + " m x " + talus::with_digits(geo.cell_y, 4) + " m" +
                      (missing > 0 ? ", " + count_text(missing) + " of them without a height" : ""));
  line("extent", talus::with_decimals(geo.west, 3) + " to " + talus::with_decimals(geo.west + grid.width(), 3) +
                     " east, " + talus::with_decimals(talus::io::MapPlace(geo, grid).south, 3) + " to " +
                     talus::with_decimals(geo.north, 3) + " north");
  line("system", talus::io::crs_name(geo.crs_wkt));
  const talus::DemFigures figures = talus::dem_figures(heights);
  if (figures.cells > 0)
    line("slopes",
         "median " + talus::with_digits(talus::degrees(figures.median_slope), 3) + " deg; " +
             talus::percent(figures.steep_share, 2) + " of the cells above 80 deg, " +
             talus::percent(figures.flat_share, 2) + " flat" +
             (figures.step > 0.0 ? "; all heights are multiples of " + talus::text_of(figures.step) + " m" : ""));
  const talus::PitSummary pits = talus::summary_of_pits(heights);
  if (pits.count > 0)
    line("pits", count_text(pits.count) + (pits.count == 1 ? " cell is" : " cells are") +
                     " lower than all eight neighbours, by up to " + talus::with_digits(pits.deepest, 3) + " m" + way);
  const talus::DamCount dams = talus::count_dammed(heights);
  if (dams.dammed > 0)
    line("dammed", count_text(dams.dammed) + (dams.dammed == 1 ? " cell is" : " cells are") +
                       " lower than the four neighbours, with a way down only diagonally" + way);
}

void print_zones(const Scenario& scenario) {
  const auto& zones = scenario.cover.zones.values;
  std::vector<std::uint64_t> cells(scenario.cover.grounds.size());
  const auto& heights = scenario.surface.heights().values;  // blocks meet no ground where there is none
  for (std::size_t cell = 0; cell < heights.size(); ++cell)
    if (!std::isnan(heights[cell])) ++cells[zones.empty() ? 0 : zones[cell]];
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string name =
        i < scenario.zone_names.size() && !scenario.zone_names[i].empty() ? scenario.zone_names[i] : "default";
    const talus::Ground& g = scenario.cover.grounds[i];
    line(i == 0 ? "ground" : "", name + ": " + count_text(cells[i]) + " cells; theta_scale " +
                                     talus::with_digits(g.theta_scale, 4) + ", psi_scale " +
                                     talus::with_digits(g.psi_scale, 4) + ", En50 " + talus::with_digits(g.En50, 4) +
                                     ", Et50 " + talus::with_digits(g.Et50, 4) + ", phi " +
                                     talus::with_digits(talus::degrees(std::atan(g.tan_phi)), 4) + " deg, shape " +
                                     range_text({g.shape_min, g.shape_max}, ""));
  }
}

/// How often blocks fall, and what that means for the rock face.
std::string frequency_text(const Scenario& scenario) {
  const auto rock = talus::annual_rock(scenario);
  if (!rock)
    return "not given; for talus hazard give it before the run (field frequency of the sources, --frequency or "
           "[frequency])";
  const std::string text =
      talus::with_digits(rock->events, 4) + " events per year, " + talus::readable(rock->volume) + " m3 of rock a year";
  if (!(rock->area > 0.0)) return text + " (points and lines have no area to compare it with)";
  return text + ": the polygons would go back by " + talus::retreat_text(rock->retreat()) + " (" +
         talus::retreat_text(talus::kMuchRetreat) + " is much in the Alps)";
}

void print_blocks(const Scenario& scenario) {
  line("sources", count_text(scenario.features.size()) +
                      (scenario.features.size() == 1 ? " feature, " : " features, ") +
                      count_text(scenario.sources.size()) + " source cells");
  const talus::Blocks& blocks = scenario.blocks;
  if (blocks.power_law.volume.high > 0.0)
    line("diameters", "power law of volume, " + range_text(blocks.power_law.volume, "m3") + ", exponent " +
                          talus::text_of(blocks.power_law.exponent));
  const auto own = std::ranges::count_if(scenario.features, [](const auto& f) { return !std::isnan(f.diameter.low); });
  const bool all_own = own > 0 && own == std::ssize(scenario.features);
  for (const talus::BlockClass& c : blocks.classes)
    if (!all_own)
      line("diameters", range_text(c.diameter, "m") +
                            (blocks.classes.size() > 1 ? ", weight " + talus::text_of(c.weight) : "") +
                            (own > 0 ? ", of features without one of their own" : ""));
  if (own > 0)
    line(all_own ? "diameters" : "", own == 1 ? "1 feature has a diameter of its own"
                                              : count_text(static_cast<std::uint64_t>(own)) +
                                                    (all_own ? "" : " of " + count_text(scenario.features.size())) +
                                                    " features have a diameter of their own");
  line("releases", count_text(scenario.sources.size()) + " x " + count_text(scenario.trajectories) + " = " +
                       count_text(scenario.released()) + " trajectories, seed " + std::to_string(scenario.seed));
  line("thresholds", talus::energy_words(scenario.output.count_rotation).name + " " +
                         list_text(scenario.output.energy_thresholds, "kJ") + "; height " +
                         list_text(scenario.output.height_thresholds, "m"));
  line("frequency", frequency_text(scenario));
  if (!scenario.screens.empty()) line("screens", count_text(scenario.screens.size()));
  if (!scenario.barriers.empty()) line("barriers", count_text(scenario.barriers.list().size()));
}

void print_estimate(const LoadedScenario& loaded, unsigned threads) {
  const Scenario& scenario = loaded.scenario;
  const double so_far = talus::io::peak_memory_mb();
  const Sample sample = trace_sample(loaded);
  const auto all = static_cast<double>(scenario.released()), traced = static_cast<double>(sample.traced);
  RunSize size;
  size.trajectories = all;
  size.grid_cells = static_cast<double>(scenario.surface.grid().cells());
  size.touched_cells = talus::expected_cells(sample.cells_by_passages, all / traced, size.grid_cells);
  size.crossings = static_cast<double>(sample.crossings) * all / traced;
  size.metres_per_path = sample.length / traced;
  size.with_hazard = talus::AnnualWeights::of(scenario).has_value();
  const int processors = threads > 0 ? threads : omp_get_num_procs();
  const double trace_seconds = sample.seconds * all / traced / processors;
  const double write_seconds = seconds_to_write(scenario, size, processors);
  line("time", "about " + duration_text(trace_seconds + write_seconds) + " on " + std::to_string(processors) +
                   " processors, " + duration_text(write_seconds) + " of them to write (" +
                   talus::with_decimals(size.metres_per_path, 0) + " m a trajectory; from a sample of " +
                   count_text(sample.traced) + ")");
  line("cells", "about " + rounded_text(size.touched_cells) + " reached (" + count_text(sample.touched_cells) +
                    " by the sample)");
  line("memory", "about " + rounded_text(so_far + 1e-6 * bytes_in_memory(scenario, size)) +
                     " MB; talus run --memory sets a limit");
  line("disk", "about " + rounded_text(1e-6 * bytes_of_results(scenario, size)) + " MB of results, up to " +
                   rounded_text(1e-6 * bytes_at_work(scenario, size)) + " MB more while it goes on");
  for (const std::string& warning : talus::run::warnings_of(sample.totals, sample.left_into_gaps, "sample"))
    line("warning", warning);
  for (const std::string& warning : talus::run::gully_warnings(sample.gullies, sample.traced, "sample"))
    line("warning", warning);
  for (const std::string& warning : talus::run::held_warnings(sample.held, sample.traced, scenario.effects, "sample"))
    line("warning", warning);
  if (talus::io::too_many_limits(sample.totals))
    line("warning", count_text(sample.totals.limited_blocks) +
                        " of the sample ended at the limit of impacts, time or vertices; where more than " +
                        talus::percent(talus::io::kAllowedLimitShare) + " do, the run ends with exit code 1");
}

void print_plan(const CheckOptions& options, const LoadedScenario& loaded) {
  print_terrain(loaded, !options.pits.empty());
  print_zones(loaded.scenario);
  for (const std::string& note : loaded.notes) line("read", note);
  if (const auto note = talus::io::coefficient_note(loaded)) line("note", *note);
  print_blocks(loaded.scenario);
  print_estimate(loaded, options.threads);
  for (const std::string& warning : loaded.warnings) line("warning", warning);
  if (const auto warning = talus::run::many_trajectories_warning(loaded.scenario.released())) line("warning", *warning);
}

/// Writes the map of the pits, if it is asked for.
void write_pits(const CheckOptions& options, const LoadedScenario& loaded) {
  if (options.pits.empty()) return;
  talus::io::OutputFile out(options.pits, ".gpkg", options.overwrite, talus::io::kPitLayers);
  for (const talus::io::InputFile& input : loaded.inputs) out.protect(input.path);
  catch_signals();
  talus::io::write_pits(out.temporary(), loaded.scenario.surface.heights(), loaded.geo,
                        talus::io::style_of(talus::io::StyledLayer::Pits));
  out.commit();
  if (!options.quiet) print("written: %s\n", options.pits.c_str());
}

int check(const CheckOptions& options) {
  std::vector<std::string> faults;
  try {
    const LoadedScenario loaded = talus::io::load_scenario(options.flags, &faults);
    if (faults.empty()) {
      write_pits(options, loaded);
      if (!options.quiet) print_plan(options, loaded);
      return 0;
    }
  } catch (const talus::InputError& error) {
    if (faults.empty()) faults.emplace_back(error.what());
  }
  for (const std::string& fault : faults) say("error", fault);
  return 2;
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "Check a scenario and print the plan; writes nothing, but for --pits");
  add_scenario_options(*command, options->flags);
  CLI::Option* pits =
      with(command->add_option("--pits", options->pits,
                               "GeoPackage to write: pits, the cells that are lower than all eight neighbours, and "
                               "dammed cells, whose way down is only diagonal"),
           new_file_of({"vector"}));
  command->add_flag("--overwrite", options->overwrite, "replace the file of --pits if it is there")->needs(pits);
  command
      ->add_option("--threads", options->threads,
                   "of the run whose time is estimated; all processors where it is not given")
      ->check(CLI::Range(1, 4096));
  add_quiet(*command, options->quiet);
  command->footer(
      "Examples:\n  talus check scenario.toml\n  talus check scenario.toml --pits pits.gpkg\n\nLists every fault of "
      "the settings and of the layers. Traces for at "
      "most " +
      talus::text_of(kSampleSeconds) + " s to estimate the time.");
  command->callback([&action, options] { action = [options] { return check(*options); }; });
}
