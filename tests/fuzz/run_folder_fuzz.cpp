#include <memory>

#include "fuzz.hpp"
#include "io/files/checksum.hpp"
#include "run/checkpoint_rows.hpp"
#include "run/checkpoint_tally.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/run/checkpoint.hpp"

namespace {

using namespace talus;

const io::LoadedScenario& plan() {
  static const io::LoadedScenario loaded = [] {
    fuzz::write(fuzz::site() / "plan.toml",
                "dem = \"dem.tif\"\n[blocks]\ndiameter = 1\n[sources]\nfile = \"cliffs.geojson\"\n");
    io::RunFlags flags;
    flags.scenario = fuzz::site() / "plan.toml";
    return io::load_scenario(flags);
  }();
  return loaded;
}

void read_rows(const std::filesystem::path& file, const std::string& sha256) {
  std::vector<std::unique_ptr<run::RowsReader>> files;
  files.push_back(std::make_unique<run::RowsReader>(file, sha256));
  Sinks sinks;
  sinks.stops = [](std::span<const StopRow>) {};
  sinks.crossings = [](std::span<const Crossing>) {};
  sinks.paths = [](const RecordedPath&) {};
  run::replay_rows(files, sinks);
}

}  // namespace

/// The first byte says which file of a part, or of a folder of results, the rest is. Its checksum is always the right
/// one, as a forger would make it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  const std::size_t which = bytes.index(6);
  const std::string content(bytes.rest()), sha256 = io::sha256_of_bytes(content);
  const Scenario& scenario = plan().scenario;
  const auto folder = fuzz::site();
  const auto file = folder / (which == 0 ? run::kCheckpointManifest : which == 1 ? "run.json" : "content.bin");
  fuzz::write(file, content);
  fuzz::refused_or_read([&] {
    Tally tally(scenario.surface.grid(), scenario.output.energy_thresholds, scenario.output.height_thresholds);
    if (which == 0) run::Checkpoint::opened(folder, plan(), false);
    if (which == 1) io::read_run(folder);
    if (which == 2) run::read_tally(file, sha256, tally);
    if (which == 3) read_rows(file, sha256);
    if (which == 4)
      io::read_hazard(
          file, [](const io::HazardHeader&) {}, [](const io::HazardRow&) {});
    if (which != 5) return;
    const Sinks sinks;
    Simulation simulation(scenario, {}, true, tally, sinks);
    run::read_reaches(file, sha256, simulation);
  });
  return 0;
}
