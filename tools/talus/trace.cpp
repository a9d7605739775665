#include <array>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_file.hpp"
#include "talus/io/results/recorded_plan.hpp"
#include "talus/io/results/write_vectors.hpp"
#include "talus/simulate/plan/plan.hpp"

namespace {

struct TraceOptions {
  std::string scenario, out;
  std::int64_t source = 0, block = 0;
};

void check_range(const char* option, std::int64_t value, std::uint64_t count, const char* what) {
  if (value < 0 || static_cast<std::uint64_t>(value) >= count)
    throw talus::InputError(std::string(option) + ": " + std::to_string(value) + " is not there; this scenario has " +
                            what + " 0 to " + std::to_string(count - 1));
}

/// Every vertex in full precision: the shortest decimals that read back as the same numbers.
void print_csv(const talus::io::LoadedScenario& loaded, const talus::Path& path) {
  const talus::io::MapPlace place(loaded.geo, loaded.scenario.surface.grid());
  print_text("time,x,y,z,vx,vy,vz,wx,wy,wz,event\n");
  for (const talus::Vertex& vertex : path.vertices) {
    const talus::Motion& m = vertex.motion;
    const std::array<double, 10> values{m.time,
                                        place.x(m.position.x()),
                                        place.y(m.position.y()),
                                        m.position.z(),
                                        m.velocity.x(),
                                        m.velocity.y(),
                                        m.velocity.z(),
                                        m.spin.x(),
                                        m.spin.y(),
                                        m.spin.z()};
    std::string line;
    for (const double value : values) line += talus::text_of(value) + ",";
    line += vertex.event == talus::Event::End ? talus::io::name_of(path.end) : talus::io::name_of(vertex.event);
    print_text(line + "\n");
  }
}

void write_geopackage(talus::io::OutputFile& out, const talus::io::LoadedScenario& loaded,
                      const talus::Release& release, const talus::Path& path) {
  const talus::Grid& grid = loaded.scenario.surface.grid();
  talus::io::TrajectoriesWriter writer(out.temporary(), loaded.geo, grid);
  writer.write({stop_row(release, path), talus::points_of(path, grid.cell_x)});
  writer.write_vertices(path);
  writer.finish();
  out.commit();
}

int trace_one(const TraceOptions& options) {
  std::optional<talus::io::OutputFile> out;
  if (!options.out.empty()) out.emplace(options.out, ".gpkg", false);
  const talus::io::LoadedScenario loaded = talus::io::recorded_or_own_plan(options.scenario);
  const talus::Scenario& scenario = loaded.scenario;
  check_range("--source", options.source, scenario.sources.size(), "sources");
  check_range("--block", options.block, scenario.trajectories, "blocks");
  const talus::Release release = talus::make_release(scenario, static_cast<std::uint32_t>(options.source),
                                                     static_cast<std::uint32_t>(options.block));
  talus::Path path;
  talus::trace(scenario.world(), release, path);
  if (out) {
    catch_signals();
    write_geopackage(*out, loaded, release, path);
  } else {
    print_csv(loaded, path);
  }
  return 0;
}

}  // namespace

void add_trace(CLI::App& app, Action& action) {
  const auto options = std::make_shared<TraceOptions>();
  CLI::App* command = app.add_subcommand("trace", "Replay one trajectory of a run, bit for bit");
  with(
      command->add_option("scenario", options->scenario, "scenario file; every run leaves its own in OUT/scenario.toml")
          ->required(),
      file_of({"toml"}));
  command->add_option("--source", options->source, "number of the source cell, as in stops.gpkg")->required();
  command->add_option("--block", options->block, "number of the block, as in stops.gpkg")->required();
  with(command->add_option("-o,--out", options->out,
                           "GeoPackage to write: the path and its vertices; without it CSV is printed"),
       new_file_of({"vector"}));
  command->footer("Example:\n  talus trace result/scenario.toml --source 17 --block 4 -o path.gpkg");
  command->callback([&action, options] { action = [options] { return trace_one(*options); }; });
}
