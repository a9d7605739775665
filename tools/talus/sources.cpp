#include <cmath>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "progress.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_file.hpp"
#include "talus/io/gdal/source_cells.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/terrain/source_slope.hpp"

namespace {

constexpr talus::Bounds kSlope{"slope", "deg", "cells at least this steep are candidate sources",
                               0.0,     90.0,  talus::Bounds::Between};

constexpr double kLikelyNoDegrees = 1.6;  // a slope below it may be in radians, or a ratio of up to 58 degrees

struct SourcesOptions {
  std::string dem, out;
  std::optional<double> slope;  // [deg]
  bool overwrite = false, quiet = false;
};

void summarise(const talus::io::SourceCells& found, const talus::Grid& grid, const std::string& threshold,
               const std::string& out) {
  say("", count_text(found.cells) + " of " + count_text(grid.cells()) + " cells are at least " + threshold +
              " steep: " + talus::with_digits(found.plan_area * 1e-4, 4) + " ha in plan, " +
              talus::with_digits(found.true_area * 1e-4, 4) + " ha of ground");
  say("", "source_polygons (" + count_text(found.polygons) + ") and source_points (" + count_text(found.cells) +
              ") are in " + out + "; these are candidates by steepness alone: look at them before a run");
}

int find_sources(const SourcesOptions& options) {
  if (options.slope)
    if (const auto rule = talus::fault_of(kSlope, *options.slope))
      throw talus::InputError("flag --slope = " + talus::with_digits(*options.slope, 6) + ": " + *rule);
  const auto keep_going = [] { return !interrupted(); };
  talus::io::OutputFile out(options.out, ".gpkg", options.overwrite, talus::io::kSourceLayers);
  out.protect(options.dem);
  const talus::io::Terrain terrain = talus::io::read_terrain(options.dem);
  catch_signals();
  if (!options.quiet)
    for (const std::string& warning : terrain.warnings) say("warning", warning);
  const talus::Grid& grid = terrain.heights.grid;
  const double cell = std::sqrt(grid.cell_x * grid.cell_y);
  const double slope = options.slope ? talus::radians(*options.slope) : talus::default_source_slope(cell);
  const std::string threshold =
      talus::with_digits(talus::degrees(slope), 4) + " deg" +
      (options.slope ? "" : " (the default for cells of " + talus::with_digits(cell, 4) + " m)");
  const talus::io::SourceCells found =
      talus::io::write_source_cells(out.temporary(), terrain, slope,
                                    {talus::io::style_of(talus::io::StyledLayer::SourceAreas),
                                     talus::io::style_of(talus::io::StyledLayer::SourcePoints)},
                                    keep_going);
  if (interrupted()) stop_interrupted();
  if (found.cells == 0)
    throw talus::InputError(options.dem + ": no cell is at least " + threshold + " steep, the steepest has " +
                            talus::with_digits(talus::degrees(found.steepest), 4) +
                            " deg; give a smaller one with --slope");
  out.commit();
  if (options.slope && *options.slope < kLikelyNoDegrees && !options.quiet)
    say("warning",
        "--slope = " + talus::text_of(*options.slope) + ": is in degrees; for a slope of 45 degrees give --slope 45");
  if (!options.quiet) summarise(found, grid, threshold, options.out);
  return 0;
}

}  // namespace

void add_sources(CLI::App& app, Action& action) {
  const auto options = std::make_shared<SourcesOptions>();
  CLI::App* command = app.add_subcommand("sources", "Find candidate source cells by the steepness of the terrain");
  with(command->add_option("--dem", options->dem, "terrain: a raster in a projected system in metres")->required(),
       file_of({"raster"}));
  with(command->add_option("-o,--out", options->out, "GeoPackage to write: the cells as polygons and as points")
           ->required(),
       new_file_of({"vector"}));
  with(command->add_option("--slope", options->slope,
                           "cells at least this steep [deg]; without it 55 cell^-0.075, which is 48.7 at 5 m"),
       number_of(kSlope));
  command->add_flag("--overwrite", options->overwrite, "replace the file if it is there");
  add_quiet(*command, options->quiet);
  command->footer(
      "Example:\n"
      "  talus sources --dem dem.tif -o cells.gpkg\n"
      "  talus run --dem dem.tif --sources cells.gpkg --diameter 1.2 -o result");
  command->callback([&action, options] { action = [options] { return find_sources(*options); }; });
}
