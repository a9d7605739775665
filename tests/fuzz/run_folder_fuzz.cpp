#include <array>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "fuzz.hpp"
#include "io/files/checksum.hpp"
#include "io/files/compression.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/run/checkpoint.hpp"

namespace {

using namespace talus;
namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

const io::LoadedScenario& plan() {
  static const io::LoadedScenario loaded = [] {
    fuzz::write(fuzz::site() / "plan.toml",
                "dem = \"dem.tif\"\n[blocks]\ndiameter = 1\n[sources]\nfile = \"cliffs.geojson\"\n"
                "[screens]\nfile = \"screens.csv\"\n");
    fuzz::write(fuzz::site() / "screens.csv", "id,wkt\nS1,\"LINESTRING (2600010 1200070, 2600090 1200070)\"\n");
    io::RunFlags flags;
    flags.scenario = fuzz::site() / "plan.toml";
    io::LoadedScenario made = io::load_scenario(flags);
    made.scenario.trajectories = 2;
    return made;
  }();
  return loaded;
}

Tally empty_tally() {
  const Scenario& scenario = plan().scenario;
  return {scenario.surface.grid(), scenario.output.energy_thresholds, scenario.output.height_thresholds};
}

/// The folder of a part that has been traced to its end; its files are in order.
const fs::path& part_folder() {
  static const fs::path folder = [] {
    const fs::path made = fuzz::site() / "part";
    fs::create_directories(made);
    run::Checkpoint checkpoint(made, plan(), {1, 2}, {});
    const Sinks sinks = checkpoint.sinks();
    Tally tally = empty_tally();
    Simulation simulation(plan().scenario, checkpoint.part(), false, tally, sinks);
    simulation.advance(1);
    checkpoint.save(simulation, tally);
    return made;
  }();
  return folder;
}

/// Opens the part, reads all of it, and traces what it says is left.
void read_part() {
  const run::Checkpoint checkpoint = run::Checkpoint::opened(part_folder(), plan(), false);
  Tally tally = empty_tally();
  Sinks sinks;
  sinks.stops = [](std::span<const StopRow>) {};
  sinks.crossings = [](std::span<const Crossing>) {};
  sinks.paths = [](const RecordedPath&) {};
  Simulation simulation(plan().scenario, checkpoint.part(), checkpoint.asked().several(), tally, sinks);
  checkpoint.restore(simulation, tally);
  checkpoint.replay(0, sinks);
  io::LoadedScenario record = plan();
  checkpoint.recall(record, 2);
  simulation.advance(1);
}

/// Files of a part, and where its manifest has their checksums.
struct PartFile {
  const char* name;
  const char* checksum;
};

/// Reads the part with other bytes in one of its files, or with what a JSON changes in its manifest (no `file`). The
/// checksums are the right ones, as a forger would make them.
void read_forged_part(const std::string& content, const PartFile* file) {
  static const std::string good = text(part_folder() / run::kCheckpointManifest);
  Json manifest = Json::parse(good);
  std::string before;
  if (file != nullptr) {
    before = text(part_folder() / file->name);
    fuzz::write(part_folder() / file->name, content);
    manifest[Json::json_pointer(file->checksum)] = io::sha256_of_bytes(content);
  } else if (const Json change = Json::parse(content, nullptr, false); change.is_object()) {
    manifest.merge_patch(change);
  }
  const auto written = [](const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; };
  manifest.erase("sha256");
  manifest["sha256"] = io::sha256_of_bytes(written(manifest));
  fuzz::write(part_folder() / run::kCheckpointManifest, written(manifest));
  fuzz::refused_or_read(read_part);
  if (file != nullptr) fuzz::write(part_folder() / file->name, before);
}

void read_hazard_file(std::string_view bytes) {
  const fs::path file = fuzz::site() / "hazard_tally.gz";
  fuzz::write(file, bytes);
  fuzz::refused_or_read([&] {
    io::read_hazard(
        file, [](const io::HazardHeader&) {}, [](const io::HazardRow&) {});
  });
}

}  // namespace

/// The first byte says which file of a part, or of a folder of results, the rest is.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr PartFile kTally{"tally-1.bin", "/tallies/0/sha256"}, kRows{"rows-1-0.bin", "/rows/0/sha256"},
      kReaches{"reach-1.bin", "/reaches/0/sha256"}, kRest{"rest-1.bin", "/rest_sha256"};
  static constexpr std::array<const PartFile*, 5> kPart{nullptr, &kTally, &kRows, &kReaches, &kRest};
  fuzz::Bytes bytes(data, size);
  const std::size_t which = bytes.index(8);
  const std::string content(bytes.rest());
  if (which < kPart.size()) {
    read_forged_part(content, kPart[which]);
  } else if (which == 5) {
    fuzz::write(fuzz::site() / "run.json", content);
    fuzz::refused_or_read([] { io::read_run(fuzz::site()); });
  } else if (which == 6) {
    read_hazard_file(content);
  } else {
    const auto zipped = io::gzipped(std::as_bytes(std::span(content)));
    read_hazard_file({reinterpret_cast<const char*>(zipped.data()), zipped.size()});
  }
  return 0;
}
